// The clock that measures the time of estimates.
#pragma once

#include <time.h>

namespace maploop::odometry {

// Returns the processor time of this thread; other work on the machine does not count.
inline double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace maploop::odometry
