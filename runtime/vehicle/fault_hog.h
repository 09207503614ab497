// Busy threads that take the machine from the graph for a while.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>
#include <vector>

#include "runtime/vehicle/fault.h"

namespace maploop::vehicle {

// Threads of the default scheduling policy that compute nothing while the data time is inside the
// window. They end with the window, with the object, or after longest_hog of machine time,
// whichever is first.
class CpuHog {
 public:
  // `position` tells the data time and is called from every thread; it and `struck`, which counts
  // the threads that became busy, must outlive the hog.
  CpuHog(int threads, FaultWindow window, std::function<Time()> position,
         std::atomic<std::uint64_t>& struck);
  ~CpuHog();  // stops and waits
  CpuHog(const CpuHog&) = delete;
  CpuHog& operator=(const CpuHog&) = delete;

 private:
  void run(FaultWindow window, std::atomic<std::uint64_t>& struck) const;

  std::function<Time()> position_;
  std::stop_source stop_;
  std::vector<std::thread> threads_;
};

}  // namespace maploop::vehicle
