// What a run of the vehicle has to say at its end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/last_place.h"
#include "estimators/fusion/self_calibration.h"
#include "msgs/archive.h"
#include "msgs/diagnostics.h"
#include "runtime/vehicle/health/episodes.h"
#include "sensors/source.h"

namespace maploop::vehicle {

struct SensorReport {
  std::string name;
  sensors::SourceReport source;
  LatencySummary lateness;  // of release
};

struct VehicleReport {
  std::vector<SensorReport> sensors;
  LatencySummary lateness;  // of release, all sensors together
  Deadlines deadlines;
  Health health;
  std::vector<Naming> named;             // of sensors, in data time
  fusion::SelfCalibrations calibration;  // what the filter has estimated of the vehicle
  fusion::PlaceUse place{};              // what became of the last place
  std::optional<fusion::LastPlace> here;
  std::optional<Bytes> ppp;  // what Vehicle::recall() takes for the ppp stage
  std::uint64_t stalls = 0;  // how often the data clock had to wait for the graph
  Duration stalled{};
  Time last{};                // data time of the fusion's last tick
  double data_seconds = 0.0;  // length of the drive that was replayed
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
  std::uint64_t peak_memory = 0;  // bytes
};

}  // namespace maploop::vehicle
