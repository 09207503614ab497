#include "runtime/vehicle/graph/graph_stage.h"

namespace maploop::vehicle {

GraphStage::GraphStage(const StageSpec& spec, Rings& rings)
    : spec_(spec), rings_(rings), bell_(rings.bell(spec)), meter_(spec) {}

void GraphStage::finish() {
  promise(Time::max());
  cuts_.finish();
  for (runtime::EdgeBase* ring : inputs_) ring->abandon();
}

void GraphStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  load(ar);
  ar.finish();
}

void GraphStage::measure(Time stamp, Time available, MonotonicTime released, MonotonicTime started,
                         MonotonicTime ended, const char* busy, const runtime::DataClock& clock) {
  const bool missed =
      meter_.worked({stamp, released, started, ended, cuts_.held_up(released, busy)},
                    clock.keeps_time(available));
  if (load_) load_->worked(to_seconds(ended - released) / to_seconds(spec_.deadline));
  if (missed) runtime::trace_instant(trace_, "missed deadline");
}

void GraphStage::measure(const runtime::Tick& tick, const TickTimes& times, const char* waiting,
                         const runtime::DataClock& clock) {
  meter_.ran(times.done - times.ready);
  if (!clock.keeps_time(tick.time)) {
    meter_.latency().record(times.done - times.ready);
    return;
  }
  meter_.woke(tick, clock, times.due, times.woken);
  const bool missed = meter_.latency().record({tick.time,
                                               times.done - times.due,
                                               {{{"woken late", times.woken - times.due},
                                                 {waiting, times.ready - times.woken},
                                                 {"running", times.done - times.ready}}}});
  if (missed) runtime::trace_instant(trace_, "missed deadline");
}

runtime::Schedule GraphStage::schedule(const runtime::DataClock& clock) const {
  return {spec_.period, spec_.phase, clock.is_live() ? spec_.overrun : runtime::Overrun::catch_up};
}

}  // namespace maploop::vehicle
