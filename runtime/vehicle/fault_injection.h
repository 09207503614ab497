// The faults of one replay, brought to where they strike.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/fault.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/fault_hog.h"
#include "runtime/vehicle/vehicle.h"

namespace maploop::vehicle {

struct FaultCount {
  std::string fault;         // as its user wrote it
  std::uint64_t struck = 0;  // samples, items of a stage, or threads
};

// Must outlive the sensors, stages and hogs it was asked for. counts() is for any thread.
class FaultInjection {
 public:
  // `origin`: stamp of the drive's first image.
  FaultInjection(std::vector<Fault> faults, Time origin);

  // The given sensors with their faults; of several on one sensor the first strikes first. A sensor
  // that is not there stays away.
  Sensors afflict(Sensors sensors);

  // For Vehicle::slow_down().
  StageDelays delays();

  // Busy from now on, as their windows say; `position` as Vehicle::position().
  std::vector<std::unique_ptr<CpuHog>> hogs(const std::function<Time()>& position);

  // Fault by fault. One that struck nothing lies outside of the drive, or its sensor is not there.
  std::vector<FaultCount> counts() const;

 private:
  struct Injected {
    Fault fault;
    FaultWindow window;
    std::atomic<std::uint64_t> struck{0};
  };
  template <class T>
  static std::unique_ptr<sensors::Source<T>> with_fault(std::unique_ptr<sensors::Source<T>> source,
                                                        Injected& injected);

  std::deque<Injected> faults_;
};

}  // namespace maploop::vehicle
