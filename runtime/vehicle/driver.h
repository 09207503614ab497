// A sensor's thread: hands the samples to the graph.
#pragma once

#include <algorithm>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/episodes.h"
#include "runtime/vehicle/meter.h"
#include "runtime/vehicle/trace_flows.h"
#include "sensors/source.h"

namespace maploop::vehicle {

template <class T>
class Driver {
 public:
  Driver(std::string name, std::vector<runtime::Edge<T>*> edges)
      : edges_(std::move(edges)), lateness_(std::move(name), {}) {}
  virtual ~Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()

  // Of a recording: loads the first sample; when it becomes available, if there is one. Call once,
  // before run().
  virtual std::optional<Time> load_first() { return std::nullopt; }
  // Leaves out what becomes available up to t; between load_first() and run().
  virtual void skip_until(Time) {}

  virtual void run(runtime::DataClock& clock, const std::stop_token& stop) = 0;

  // Nothing more comes; also after a failure.
  void finish() {
    for (auto* edge : edges_) edge->finish();
  }

  // It has no sensor.
  virtual bool absent() const = 0;

  // How long after its due time each sample was released.
  const Meter& lateness() const { return lateness_; }

  // Of the samples released.
  ArrivalWatch& arrivals() { return arrivals_; }

  // After the end.
  virtual sensors::SourceReport report() const = 0;

  // Of a live sensor, as it was lately; one thread at a time may ask, also meanwhile.
  virtual std::optional<SensorHealth> health() { return std::nullopt; }

 protected:
  void promise(Time t) {
    for (auto* edge : edges_) edge->promise(t);
  }

  // Releases it now, in exchange for a sample with the buffers of an old one.
  void release(T& sample, runtime::DataClock& clock, const std::stop_token& stop) {
    runtime::TraceSpan span(trace_, "release");
    if constexpr (requires { flow_of(sample); }) span.start_flow(flow_of(sample));
    const Time available = sample.available;
    const MonotonicTime due = clock.due(available);
    sample.received = runtime::monotonic_now();
    lateness_.record(std::max(Duration::zero(), sample.received - due));
    arrivals_.arrived(available);
    const MonotonicTime received = sample.received;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const bool last_edge = i + 1 == edges_.size();
      edges_[i]->push(sample.stamp, stop, [&](T& slot) {
        if (last_edge) {
          std::swap(slot, sample);  // buffers circulate, nothing is copied
        } else {
          slot = sample;
        }
      });
    }
    const MonotonicTime now = runtime::monotonic_now();
    if (now - received > runtime::DataClock::tolerance && clock.stall(available, now)) {
      runtime::trace_instant(trace_, "stall");
    }
  }

 private:
  std::vector<runtime::Edge<T>*> edges_;
  Meter lateness_;
  ArrivalWatch arrivals_;
  runtime::TraceBuffer* trace_ = nullptr;
};

}  // namespace maploop::vehicle
