// Runs busy threads that take CPU time from the graph for a while.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <thread>
#include <vector>

#include "runtime/vehicle/faults/fault.h"

namespace maploop::vehicle {

// A CpuHog runs threads of the default scheduling policy that are busy while the data time is
// inside the window. They end with the window, with the object, or after longest_hog of machine
// time, whichever comes first.
class CpuHog {
 public:
  // `position` returns the data time and is called from every thread. `struck` counts the threads
  // that became busy. It must outlive the hog, and so must what `position` uses.
  CpuHog(int threads, FaultWindow window, std::function<Time()> position,
         std::atomic<std::uint64_t>& struck);
  ~CpuHog();  // stops the threads and waits for them
  CpuHog(const CpuHog&) = delete;
  CpuHog& operator=(const CpuHog&) = delete;

 private:
  void run(FaultWindow window, std::atomic<std::uint64_t>& struck) const;

  std::function<Time()> position_;
  std::stop_source stop_;
  std::vector<std::thread> threads_;
};

}  // namespace maploop::vehicle
