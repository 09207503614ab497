// This file runs a function at a fixed rate on absolute time.
#pragma once

#include <cstdint>
#include <stop_token>

#include "msgs/time.h"

namespace maploop::runtime {

// States what happens to ticks that fell due while an earlier one was running, or while the thread
// was not woken. Skipping depends on the machine's speed: it must not be used where a replay must
// compute the same bits.
enum class Overrun {
  catch_up,  // each is run, one directly after the other
  skip,      // only the newest one due is run; the others are left out and counted
};

struct Schedule {
  Duration period;
  Duration phase{};  // ticks are at whole multiples of the period (since 1970) plus this
  Overrun overrun = Overrun::catch_up;
};

struct Tick {
  Time time{};                 // when it was due: a multiple of the period plus the phase
  std::uint64_t left_out = 0;  // ticks between the previous one and this one
};

// Returns the first tick at or after t.
inline Time first_tick(Time t, Duration period, Duration phase = {}) {
  const Duration since = t.time_since_epoch() - phase;
  Duration rest = since % period;
  if (rest < Duration::zero()) rest += period;
  return rest == Duration::zero() ? t : t + (period - rest);
}

// Calls body(tick) when each tick falls due: first_tick(from), then every period of data time.
// Ticks are absolute, so they never drift. Ends when the body returns false or stop is requested.
// Clock is DataClock, or a test's with sleep_until(), keeps_time() and now(). If the clock does not
// keep time (virtual time, skipping), no tick is ever late.
template <class Clock, class Body>
void run_periodic(const Clock& clock, Time from, const Schedule& schedule,
                  const std::stop_token& stop, Body&& body) {
  for (Time next = first_tick(from, schedule.period, schedule.phase); clock.sleep_until(next, stop);
       next += schedule.period) {
    Tick tick{next};
    const bool may_be_late = schedule.overrun == Overrun::skip && clock.keeps_time(next);
    const auto due_behind = may_be_late ? (clock.now() - next) / schedule.period : 0;
    if (due_behind > 0) {
      tick.left_out = static_cast<std::uint64_t>(due_behind);
      tick.time = next += due_behind * schedule.period;
    }
    if (!body(tick)) return;
  }
}

}  // namespace maploop::runtime
