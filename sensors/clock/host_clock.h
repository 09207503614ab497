// The clock that live samples are stamped with.
#pragma once

#include "msgs/time.h"

namespace maploop::sensors {

// UTC as this machine had it at the start, and from then on by its steady clock: setting the
// machine's clock, or a leap second, moves no stamp. step() tells how far they are apart by now.
// For any thread.
class HostClock {
 public:
  HostClock() : utc_(utc()), steady_(steady()) {}

  Time now() const { return utc_ + (steady() - steady_); }
  // How much the machine's clock was set ahead since the start.
  Duration step() const { return utc() - now(); }

 private:
  static Time utc() {
    return std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
  }
  static MonotonicTime steady() {
    return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
  }

  Time utc_;
  MonotonicTime steady_;
};

}  // namespace maploop::sensors
