// The clock that estimates are timed by.
#pragma once

#include <time.h>

namespace maploop::odometry {

// Processor time of this thread: what else runs on the machine is not in it.
inline double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace maploop::odometry
