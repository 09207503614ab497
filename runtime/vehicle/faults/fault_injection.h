// Applies the faults of one replay to its sensors, its stages and the machine.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/vehicle/faults/fault.h"
#include "runtime/vehicle/faults/fault_delay.h"
#include "runtime/vehicle/faults/fault_source.h"
#include "runtime/vehicle/graph/sensors.h"

namespace maploop::vehicle {

struct FaultCount {
  std::string fault;         // as the user wrote it
  std::uint64_t struck = 0;  // samples, items of a stage, or threads
};

// A FaultInjection must outlive the sensors, delays and hogs that it returned. Any thread may call
// counts().
class FaultInjection {
 public:
  // `origin` is the stamp of the drive's first image; `focal_length` (px) is that of the cameras.
  FaultInjection(std::vector<Fault> faults, Time origin, double focal_length);

  // Returns the given sensors with their faults. Several faults on one sensor are applied in their
  // order. A sensor that is missing stays missing. Throws std::invalid_argument for a fault of
  // fixes (bias, drift, spoofed) where the sensors have observations in their place.
  Sensors inject(Sensors sensors);

  // Returns the delays for Vehicle::slow_down().
  StageDelays delays();

  // Starts the threads of the hogs, with the default scheduling policy. Each is busy while the data
  // time is inside its window, and ends with the window, with its object, or after longest_hog of
  // machine time. `position` is Vehicle::position(), which they call.
  std::vector<std::jthread> hogs(const std::function<Time()>& position);

  // Returns one count for each fault. A count of 0 means that the fault lies outside of the drive,
  // or that its target is missing.
  std::vector<FaultCount> counts() const;

 private:
  std::deque<ActiveFault> faults_;
};

}  // namespace maploop::vehicle
