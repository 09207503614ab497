// Configurations of the filter by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "estimators/fusion/fusion_parameters.h"

namespace maploop::fusion {

// What joins the reduced IMU (RI):
//   VO-RI     speed and turning of the visual odometry
//   VO-L-RI   the same of the visual-LiDAR odometry
//   RISS      the wheels' speed alone
//   RISS-VO   the wheels' speed, and the turning of the visual odometry
// and each with GNSS+ before it: fixes are used after the start too. `GPS + VO-RI` is the same as
// GNSS+VO-RI.
struct Configuration {
  std::string name;  // in its plain form
  bool lidar = false;
  bool gnss = false, odometry_speed = false, odometry_azimuth = false, wheel_speed = false;
};

std::vector<std::string> configuration_names();

// Case, blanks and GPS for GNSS do not matter. Throws std::invalid_argument listing the names.
Configuration configuration(std::string_view name);

void apply(const Configuration& configuration, FusionParameters& parameters);

// Noise of the inertial sensors by their grade: "tactical" (the defaults: KITTI's recorded unit) or
// "mems" (300 deg/h and 20 mg at turn-on). Throws std::invalid_argument listing the names.
void apply_grade(std::string_view grade, FusionParameters& parameters);

}  // namespace maploop::fusion
