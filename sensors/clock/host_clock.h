// This file provides the clock that stamps live samples.
#pragma once

#include "msgs/time.h"

namespace maploop::sensors {

// Follows UTC as this machine had it at the start, and advances with the steady clock from then on:
// setting the machine's clock, or a leap second, does not move any stamp. step() returns how far
// the two are apart now. May be used by any thread.
class HostClock {
 public:
  // `now_utc` is the machine's clock; a test may pass another one that it can set.
  explicit HostClock(Time (*now_utc)() = machine_utc)
      : now_utc_(now_utc), utc_(now_utc()), steady_(steady()) {}

  Time now() const { return utc_ + (steady() - steady_); }
  // Returns the time on the steady clock at which this clock shows t.
  MonotonicTime shows(Time t) const { return steady_ + (t - utc_); }
  // Returns by how much the machine's clock was set ahead since the start.
  Duration step() const { return now_utc_() - now(); }

  static Time machine_utc() {
    return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
  }

 private:
  static MonotonicTime steady() {
    return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
  }

  Time (*now_utc_)();
  Time utc_;
  MonotonicTime steady_;
};

}  // namespace maploop::sensors
