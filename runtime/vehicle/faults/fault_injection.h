// Applies the faults of one replay to its sensors, its stages and the machine.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault.h"
#include "runtime/vehicle/faults/fault_delay.h"
#include "runtime/vehicle/faults/fault_hog.h"
#include "runtime/vehicle/graph/vehicle.h"

namespace maploop::vehicle {

struct FaultCount {
  std::string fault;         // as the user wrote it
  std::uint64_t struck = 0;  // samples, items of a stage, or threads
};

// A FaultInjection must outlive the sensors, delays and hogs that it returned. Any thread may call
// counts().
class FaultInjection {
 public:
  // `origin` is the stamp of the drive's first image.
  FaultInjection(std::vector<Fault> faults, Time origin);

  // Returns the given sensors with their faults. Several faults on one sensor are applied in their
  // order. A sensor that is missing stays missing.
  Sensors inject(Sensors sensors);

  // Returns the delays for Vehicle::slow_down().
  StageDelays delays();

  // Starts the hogs, each of which is busy in its window; `position` is Vehicle::position().
  std::vector<std::unique_ptr<CpuHog>> hogs(const std::function<Time()>& position);

  // Returns one count for each fault. A count of 0 means that the fault lies outside of the drive,
  // or that its target is missing.
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
