// Filter configurations are selected by name here.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "estimators/fusion/fusion_parameters.h"

namespace maploop::fusion {

// A configuration says which aids correct the reduced IMU (RI):
//   auto      all that is there: GNSS, and speed and turning from visual-LiDAR or visual odometry
//   VO-RI     speed and turning from visual odometry
//   VO-L-RI   speed and turning from visual-LiDAR odometry
//   RISS      speed from the wheels only
//   RISS-VO   speed from the wheels, turning from visual odometry
//   RI        nothing: a vehicle without odometry and wheels
//   GNSS      fixes alone, without the inertial samples either
// With the prefix GNSS+ the filter also uses fixes after the start. `GPS + VO-RI` means the same as
// GNSS+VO-RI.
struct Configuration {
  std::string name;  // normalized: upper case but auto, no blanks, GNSS for GPS
  bool inertial = true, lidar = false;
  bool gnss = false, odometry_speed = false, odometry_azimuth = false, wheel_speed = false;
};

std::vector<std::string> configuration_names();

// Ignores case and blanks, and accepts GPS for GNSS. Throws std::invalid_argument, which lists the
// valid names, if `name` is not one of them.
Configuration configuration(std::string_view name);

void apply(const Configuration& configuration, FusionParameters& parameters);

// Sets the noise of the inertial sensors by their grade: "tactical" (the defaults, KITTI's recorded
// unit) or "mems" (turn-on biases of 300 deg/h and 20 mg). Throws std::invalid_argument, which
// lists the valid names, for any other grade.
void apply_grade(std::string_view grade, FusionParameters& parameters);

}  // namespace maploop::fusion
