#include "runtime/vehicle/health/thread_meter.h"

#include <algorithm>
#include <cmath>

namespace maploop::vehicle {

ThreadMeter::ThreadMeter(const StageSpec& stage)
    : period_(stage.period),
      has_deadline_(stage.deadline > Duration::zero()),
      latency_(stage.name, stage.deadline) {}

void ThreadMeter::woke(const runtime::Tick& tick, const runtime::DataClock& clock,
                       MonotonicTime due, MonotonicTime woken) {
  wake_up_.record(woken - due);
  if (last_woken_ != MonotonicTime{}) {
    period_jitter_.record(std::chrono::abs((woken - last_woken_) - (due - last_due_)));
  }
  last_woken_ = woken;
  last_due_ = due;

  left_out_.fetch_add(tick.left_out, std::memory_order_relaxed);
  const Duration interval = std::max(
      Duration(1), Duration(std::llround(static_cast<double>(period_.count()) / clock.speed())));
  const Duration stalled = clock.stalled();
  const Duration left_out = static_cast<Duration::rep>(tick.left_out + 1) * interval;
  latency_.record_shift(stalled - stalled_, interval);
  if (tick.left_out > 0) latency_.record_shift(woken - due + left_out, interval);
  stalled_ = stalled;
}

bool ThreadMeter::worked(const Work& work, bool timed) {
  const Duration running = work.ended - work.started;
  const MonotonicTime ready = std::max(work.released, idle_since_);
  idle_since_ = work.ended;
  ran(running);
  if (!timed) {
    latency_.record(running);
    return false;
  }
  woke(work.started - ready);
  return latency_.record({work.stamp,
                          work.ended - work.released,
                          {{{work.busy_before, ready - work.released},
                            {"woken late", work.started - ready},
                            {"running", running}}}});
}

}  // namespace maploop::vehicle
