// The clock that live samples are stamped with.
#pragma once

#include "msgs/time.h"

namespace maploop::sensors {

// UTC as this machine had it at the start, and from then on by its steady clock: setting the
// machine's clock, or a leap second, moves no stamp. step() tells how far they are apart by now.
// For any thread.
class HostClock {
 public:
  // `now_utc`: the machine's clock, or another for a test of what follows when it is set.
  explicit HostClock(Time (*now_utc)() = machine_utc)
      : now_utc_(now_utc), utc_(now_utc()), steady_(steady()) {}

  Time now() const { return utc_ + (steady() - steady_); }
  // When it shows t, on the steady clock.
  MonotonicTime shows(Time t) const { return steady_ + (t - utc_); }
  // How much the machine's clock was set ahead since the start.
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
