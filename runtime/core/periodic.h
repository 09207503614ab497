// Fixed-rate execution on absolute time.
#pragma once

#include <stop_token>

#include "runtime/core/data_clock.h"

namespace maploop::runtime {

// The first multiple of `period` (counted from 1970) at or after t.
inline Time first_tick(Time t, Duration period) {
  const Duration since_epoch = t.time_since_epoch();
  const Duration rest = since_epoch % period;
  return rest == Duration::zero() ? t : t + (period - rest);
}

// Calls body(tick) when each tick falls due: first_tick(from), then every `period` of data time.
// Ticks are absolute, so they never drift; a late tick is followed at once by the ones behind it,
// and none is left out, because the result of a tick must not depend on the machine's speed.
// Ends when the body returns false or stop is requested.
template <class Body>
void run_periodic(const DataClock& clock, Time from, Duration period, const std::stop_token& stop,
                  Body&& body) {
  for (Time tick = first_tick(from, period); clock.sleep_until(tick, stop); tick += period) {
    if (!body(tick)) return;
  }
}

}  // namespace maploop::runtime
