// This file finds where the sensors of a recorded drive are, and how late their stamps, from how
// they move.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "msgs/vehicle_description.h"
#include "tools/calibrate/extrinsics/joint_rotation.h"
#include "tools/calibrate/extrinsics/lever.h"
#include "tools/calibrate/extrinsics/rate_alignment.h"
#include "tools/calibrate/extrinsics/sensor_motions.h"

namespace maploop::extrinsics {

// A value is observed, and written, if its standard deviation is at most this.
inline constexpr double observed_angle = 1.0;      // deg
inline constexpr double observed_delay = 0.02;     // s
inline constexpr double observed_position = 0.15;  // m

// This is the value that was found for one key of the vehicle description.
struct FoundValue {
  std::string table, key, unit;  // as in "vehicle.camera", "yaw", "deg"
  double before = 0.0, value = 0.0, sigma = 0.0;
  bool observed = false;
};

// This is the alignment of two sensors, such as "inertial unit" and "camera".
struct SensorPair {
  std::string a, b;
  RateAlignment rates;  // of a against b
};

struct Extrinsics {
  std::vector<SensorPair> pairs;
  std::optional<HandEye> camera_lidar;
  double contradiction = 0.0;  // of the rotations of all pairs (joint_rotation.h)
  std::vector<FoundValue> values;
  std::vector<std::string> sentences;  // what cannot be found, and why
  VehicleDescription description;      // with the observed values in it
};

// Returns why an alignment found nothing, for a sentence.
std::string reason(const RateAlignment& alignment);

// Measured beforehand, so that it can be made up in tests.
struct Measurements {
  CameraMotions camera;
  LidarMotions lidar;
  InertialRates inertial;
};

// Reads the recording. Progress is called with the stamps of images and scans.
Measurements measure(const vehicle::Recording& recording, const vehicle::VehicleConfig& config,
                     const Stretch& stretch, const Progress& progress);

// The poses and delays of `described` are those that the measurements were made with, and where the
// search begins. The camera's place and delay are taken as they are described: the others' delays
// are found against it, and where there is no camera the inertial unit's against the LiDAR's.
Extrinsics find_extrinsics(const Measurements& measurements, const VehicleDescription& described);

}  // namespace maploop::extrinsics
