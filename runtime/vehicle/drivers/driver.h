// A sensor's thread: hands its samples to the graph.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/thread.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/graph/rings.h"
#include "runtime/vehicle/graph/trace_flows.h"
#include "runtime/vehicle/health/episodes.h"
#include "runtime/vehicle/health/thread_meter.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// What the graph needs of a driver of which it does not know the sample's type.
class DriverBase {
 public:
  explicit DriverBase(const StageSpec& spec) : spec_(spec), meter_(spec) {}
  virtual ~DriverBase() = default;
  DriverBase(const DriverBase&) = delete;
  DriverBase& operator=(const DriverBase&) = delete;

  const StageSpec& spec() const { return spec_; }
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()

  // Recordings: loads the first sample and returns when it becomes available; nothing: there is no
  // sample. Call once, before run().
  virtual std::optional<Time> load_first() { return std::nullopt; }
  // Skips what becomes available up to t; between load_first() and run().
  virtual void skip_until(Time) {}

  virtual void run(runtime::DataClock& clock, const std::stop_token& stop) = 0;

  // Nothing more comes, also after a failure.
  virtual void finish() = 0;

  // Up to which time all of its samples have been sent; any thread.
  virtual Time promised() const = 0;

  // How long after its due time each sample was released, and the processor time of each: all that
  // this thread took since the sample before, so that no wait for a reader, a loader or a sensor is
  // in it.
  const ThreadMeter& meter() const { return meter_; }

  // Of the samples released.
  ArrivalWatch& arrivals() { return arrivals_; }

  // After the end.
  virtual sensors::SourceReport report() const = 0;

  // The recent state of a live sensor; one thread at a time may ask, also while it runs.
  virtual std::optional<SensorHealth> health() { return std::nullopt; }

  // Samples of a live sensor that were thinned or left out under overload; any thread.
  virtual std::uint64_t shed() const { return 0; }

 protected:
  runtime::TraceBuffer* trace() { return trace_; }
  // At the beginning of run(): what the thread took for its start is of no sample.
  void begin_steps() { used_ = runtime::this_thread_cpu_time(); }
  void woke(Duration late) { meter_.woke(late); }
  void end_step() {
    const Duration before = std::exchange(used_, runtime::this_thread_cpu_time());
    meter_.ran(used_ - before);
  }

 private:
  const StageSpec& spec_;
  ThreadMeter meter_;
  Duration used_{};  // processor time up to the end of the last step
  ArrivalWatch arrivals_;
  runtime::TraceBuffer* trace_ = nullptr;
};

template <class T>
class Driver : public DriverBase {
 public:
  Driver(const StageSpec& spec, Outputs<T> outputs)
      : DriverBase(spec), outputs_(std::move(outputs)) {}

  void finish() override { promise(Time::max()); }
  Time promised() const override {
    return outputs_.rings().empty() ? Time::max() : outputs_.rings().front()->promised();
  }

 protected:
  void promise(Time t) {
    for (auto* ring : outputs_.rings()) ring->promise(t);
  }

  // Releases it now, in exchange for a sample with the buffers of an old one.
  void release(T& sample, runtime::DataClock& clock, const std::stop_token& stop) {
    runtime::TraceSpan span(trace(), "release");
    if constexpr (requires { flow_of(sample); }) span.start_flow(flow_of(sample));
    const Time available = sample.available;
    const MonotonicTime due = clock.due(available);
    sample.received = runtime::monotonic_now();
    woke(std::max(Duration::zero(), sample.received - due));
    arrivals().arrived(available);
    const MonotonicTime received = sample.received;
    for (auto* ring : outputs_.rings()) {
      const bool last = ring == outputs_.rings().back();
      ring->push(stop, [&](T& slot) {
        if (last) {
          std::swap(slot, sample);  // buffers circulate, nothing is copied
        } else {
          slot = sample;
        }
      });
    }
    const MonotonicTime now = runtime::monotonic_now();
    if (now - received > runtime::DataClock::tolerance && clock.stall(available, now)) {
      runtime::trace_instant(trace(), "stall");
    }
    end_step();
  }

 private:
  Outputs<T> outputs_;
};

}  // namespace maploop::vehicle
