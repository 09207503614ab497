// This file compares the stamps of a recording's sensors by how they turn.
#pragma once

#include <string>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tools/calibrate/extrinsics/sensor_motions.h"
#include "tools/web/table.h"

namespace maploop::tools {

struct TimeOffset {
  std::string a, b;  // as sensors are named in the table of the doctor
  bool found = false;
  double offset = 0.0;       // ms, by which a's stamps are later than b's, as described
  double sigma = 0.0;        // ms
  double correlation = 0.0;  // of their rates of turn, at that offset
  std::string finding;       // why it is not found
};

extern const web::Columns<TimeOffset> time_offset_columns;

// Returns the 20 s in which the inertial unit turns most; the first 20 s if there is none.
extrinsics::Stretch turning_stretch(const vehicle::Recording& recording);

// Measures camera, LiDAR and inertial unit over that stretch (calibrate/extrinsics). It takes as
// long as their odometry, some ten seconds.
std::vector<TimeOffset> time_offsets(const vehicle::Recording& recording,
                                     vehicle::VehicleConfig config,
                                     const extrinsics::Stretch& stretch,
                                     const extrinsics::Progress& progress = {});

// Returns sentences about what the offsets mean.
std::vector<std::string> advice(const std::vector<TimeOffset>& offsets, const std::string& path);

}  // namespace maploop::tools
