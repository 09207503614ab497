// This file measures how the sensors of a recording move, each by itself and in its own axes.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/imu/mount_alignment.h"
#include "tools/calibrate/extrinsics/rotation_stream.h"
#include "tools/calibrate/extrinsics/sensor_views.h"

namespace maploop::extrinsics {

// The part of a recording that is used.
struct Stretch {
  Time from = Time::min(), to = Time::max();

  bool contains(Time t) const { return from <= t && t <= to; }
};

struct SensorMotions {
  std::vector<SensorMotion> motions;  // those that odometry vouches for
  int samples = 0;                    // images or scans
};

// What a camera or a LiDAR saw is kept now and then, of at most a few hundred moments.
struct CameraMotions : SensorMotions {
  StereoCalibration calibration;
  std::vector<CameraView> views;
};
struct LidarMotions : SensorMotions {
  std::vector<LidarView> views;
};

// Called with the stamp of each image or scan.
using Progress = std::function<void(Time)>;

// Stereo odometry, in the axes of the left camera; LiDAR odometry that no image helps, in the
// scanner's, as config.vehicle describes them (vehicle::describe_car()). There is no sample of a
// sensor that the recording lacks.
CameraMotions camera_motions(const vehicle::Recording& recording,
                             const vehicle::VehicleConfig& config, const Stretch& stretch,
                             const Progress& progress);
LidarMotions lidar_motions(const vehicle::Recording& recording,
                           const vehicle::VehicleConfig& config, const Stretch& stretch,
                           const Progress& progress);

struct InertialRates {
  std::vector<RateSample> samples;      // in the body's axes
  bool vertical_alone = false;          // the unit has one gyro: the others' rates are zero
  std::optional<sensors::Mount> mount;  // of a unit whose axes had to be found on the way
};

InertialRates inertial_rates(const vehicle::Recording& recording, const Stretch& stretch);

}  // namespace maploop::extrinsics
