// A sensor driver of a recording: releases each sample when it falls due.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/meter.h"
#include "runtime/vehicle/trace_flows.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Without a source (a recording that lacks the sensor) it finishes at once.
template <class T>
class ReplayDriver {
 public:
  ReplayDriver(std::string name, std::unique_ptr<sensors::Source<T>> source,
               std::vector<runtime::Edge<T>*> edges)
      : source_(std::move(source)), edges_(std::move(edges)), lateness_(std::move(name), {}) {}

  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()

  // Loads the first sample; when it becomes available, if there is one. Call once, before run().
  std::optional<Time> load_first() {
    more_ = source_ != nullptr && source_->next(sample_);
    return more_ ? std::optional(sample_.available) : std::nullopt;
  }

  // Leaves out what becomes available up to t; between load_first() and run().
  void skip_until(Time t) {
    while (more_ && sample_.available <= t) more_ = source_->next(sample_);
  }

  void run(runtime::DataClock& clock, const std::stop_token& stop) {
    Time last = Time::min();
    for (; more_; more_ = source_->next(sample_)) {
      if (sample_.available <= last) {
        throw std::logic_error("the source of '" + lateness_.name() +
                               "' broke its promise of increasing times at sample " +
                               std::to_string(sample_.sequence));
      }
      last = sample_.available;
      // Consumers need not wait for a sample that is still to come.
      for (auto* edge : edges_) edge->promise(last - Duration(1));
      if (!clock.sleep_until(last, stop)) return;
      release(clock, stop);
      for (auto* edge : edges_) edge->promise(last);
    }
  }

  bool absent() const { return source_ == nullptr; }

  // Nothing more comes; also after a failure.
  void finish() {
    for (auto* edge : edges_) edge->finish();
  }

  // How long after its due time each sample was released.
  const Meter& lateness() const { return lateness_; }

  sensors::SourceReport report() const {
    return source_ != nullptr ? source_->report() : sensors::SourceReport{};
  }

 private:
  void release(runtime::DataClock& clock, const std::stop_token& stop) {
    runtime::TraceSpan span(trace_, "release");
    if constexpr (requires { flow_of(sample_); }) span.start_flow(flow_of(sample_));
    const Time available = sample_.available;
    const MonotonicTime due = clock.due(available);
    sample_.received = runtime::monotonic_now();
    lateness_.record(std::max(Duration::zero(), sample_.received - due));
    const MonotonicTime received = sample_.received;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const bool last_edge = i + 1 == edges_.size();
      edges_[i]->push(sample_.stamp, stop, [&](T& slot) {
        if (last_edge) {
          std::swap(slot, sample_);  // buffers circulate, nothing is copied
        } else {
          slot = sample_;
        }
      });
    }
    const MonotonicTime now = runtime::monotonic_now();
    if (now - received > runtime::DataClock::tolerance && clock.stall(available, now)) {
      runtime::trace_instant(trace_, "stall");
    }
  }

  std::unique_ptr<sensors::Source<T>> source_;
  std::vector<runtime::Edge<T>*> edges_;
  Meter lateness_;
  runtime::TraceBuffer* trace_ = nullptr;
  T sample_{};
  bool more_ = false;
};

}  // namespace maploop::vehicle
