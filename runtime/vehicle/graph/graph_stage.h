// What all estimator stages have in common: one thread with inputs, outputs, measures and
// snapshots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "msgs/archive.h"
#include "msgs/diagnostics.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/periodic.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/faults/fault_delay.h"
#include "runtime/vehicle/graph/rings.h"
#include "runtime/vehicle/graph/stage_cuts.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "runtime/vehicle/health/episodes.h"
#include "runtime/vehicle/health/load_shedding.h"
#include "runtime/vehicle/health/thread_meter.h"

namespace maploop::vehicle {

class GraphStage {
 public:
  // `spec` and `rings` must outlive the stage.
  GraphStage(const StageSpec& spec, Rings& rings);
  virtual ~GraphStage() = default;
  GraphStage(const GraphStage&) = delete;
  GraphStage& operator=(const GraphStage&) = delete;

  const StageSpec& spec() const { return spec_; }

  // The stage's thread: runs until the inputs are finished or stop is requested. `begin`: the data
  // time at which this run begins.
  virtual void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) = 0;
  // Nothing more is sent or taken, also after a failure.
  void finish();
  // Any thread: makes run() look at its stop token.
  void wake() { bell_.ring(); }

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void tell_load(std::shared_ptr<LoadShedding> load) { load_ = std::move(load); }
  void save_at(SnapshotMoments moments, runtime::Edge<StageSnapshot>& ring) {
    cuts_.set(std::move(moments), ring);
  }
  // Restores what was saved; throws ArchiveError if it is from another version or configuration.
  void resume(std::span<const std::uint8_t> saved);
  // Takes what was saved in an earlier run on other data, as far as it still helps; before run().
  // Throws as resume() does.
  virtual void recall_saved(std::span<const std::uint8_t> /*saved*/) {}
  // Returns what recall_saved() takes; after run().
  virtual Bytes kept() { return {}; }
  // Memory that is mapped beforehand for a saved state; a larger one is not an error.
  virtual std::size_t saved_bytes() const = 0;

  const ThreadMeter& meter() const { return meter_; }
  const std::vector<runtime::EdgeBase*>& inputs() const { return inputs_; }
  // Which of its inputs the estimator refuses, and what it refused so far by reason; the health
  // thread asks, also while the stage runs.
  virtual std::vector<UseWatch*> uses() { return {}; }
  virtual std::vector<RefusalCount> refusals() = 0;
  // What limits the results at present, as a sentence; empty: nothing. Any thread.
  virtual std::string degraded() const { return {}; }

 protected:
  // nullptr: this vehicle does not have the ring.
  template <class T>
  runtime::Edge<T>* input(const RingSpec<T>& spec) {
    runtime::Edge<T>* ring = rings_.consumer(spec);
    if (ring != nullptr) inputs_.push_back(ring);
    return ring;
  }
  // Adds the ring to the intake if this vehicle has it.
  template <class T, class Handle>
  void take(runtime::Intake& intake, const RingSpec<T>& spec, Handle handle) {
    if (runtime::Edge<T>* ring = input(spec)) intake.add(*ring, std::move(handle));
  }
  template <class T, class... More>
  Outputs<T> outputs(const RingSpec<T>& first, const More&... more) {
    Outputs<T> to = rings_.outputs(first, more...);
    outputs_.insert(outputs_.end(), to.rings().begin(), to.rings().end());
    return to;
  }
  // On all outputs: every result with `available` up to t has been sent.
  void promise(Time t) {
    for (runtime::EdgeBase* ring : outputs_) ring->promise(t);
  }
  virtual void load(ArchiveReader& ar) = 0;

  // Measures one step of a stage that samples release. `busy` (a string literal) names what a
  // sample waits for while the step before it runs.
  void measure(Time stamp, Time available, MonotonicTime released, MonotonicTime started,
               MonotonicTime ended, const char* busy, const runtime::DataClock& clock);

  // Measures one tick of a stage with a fixed rate. `waiting`: which input it waited for from
  // `woken` to `ready`.
  struct TickTimes {
    MonotonicTime due, woken, ready, done;
  };
  void measure(const runtime::Tick& tick, const TickTimes& times, const char* waiting,
               const runtime::DataClock& clock);

  // The schedule that the declaration gives the stage: only a live run leaves ticks out.
  runtime::Schedule schedule(const runtime::DataClock& clock) const;

  runtime::Doorbell& bell() { return bell_; }
  runtime::TraceBuffer* trace() { return trace_; }
  StageCuts& cuts() { return cuts_; }
  void delay(Time t) const { delay_(t); }

 private:
  const StageSpec& spec_;
  Rings& rings_;
  runtime::Doorbell& bell_;
  std::vector<runtime::EdgeBase*> inputs_;
  std::vector<runtime::EdgeBase*> outputs_;
  ThreadMeter meter_;
  StageDelay delay_;
  std::shared_ptr<LoadShedding> load_;  // nullptr: nothing is shed
  StageCuts cuts_;
  runtime::TraceBuffer* trace_ = nullptr;
};

}  // namespace maploop::vehicle
