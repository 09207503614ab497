// This file defines the two outputs of the fusion: the absolute pose and the continuous one.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "msgs/frames.h"
#include "msgs/nav_protection.h"
#include "msgs/nav_state.h"
#include "msgs/sample.h"

namespace maploop {

// This is the pose in the frame of odometry (`odom` of REP 105): it agrees with enu at the filter's
// start, moves only by relative motions, never jumps, and drifts away from enu without bound.
struct OdomState : Sample {
  // As in the NavState of the same stamp, but uninitialized as long as that is without a course.
  NavStatus status = NavStatus::uninitialized;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();       // m, the IMU's
  Attitude attitude;                                        // azimuth clockwise from odom's y axis
  Eigen::Vector3d velocity_body = Eigen::Vector3d::Zero();  // m/s, forward, left, up
  double yaw_rate = 0.0;                                    // rad/s, without the gyro's bias

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), status, position, attitude, velocity_body, yaw_rate);
  }
};

// This is how far the sensors of odometry are mounted beside their description, as the fusion has
// found it so far. The body of a fused state looks along the travel.
struct OdometryMount {
  double course = 0.0;  // rad, their described forward axis points to the right of the travel
  double left = 0.0;    // m, they are described too far to the left

  // Returns the pose of the described axes, in which the sensors' poses are given, in those of the
  // body.
  Eigen::Isometry3d T_body_described() const {
    return Eigen::Translation3d(0.0, -left, 0.0) *
           Eigen::AngleAxisd(course, Eigen::Vector3d::UnitZ());
  }

  void archive(auto& ar) { ar(course, left); }
};

// This is what the fusion gives out: the pose in the frame of the map, which fixes and roads may
// move at once, and that in the frame of odometry. Both have the same stamp.
struct FusedState : NavState {
  OdomState odom;                           // the pose in the frame of odometry
  OdometryMount mount;                      // of odometry's sensors, beside their description
  std::optional<NavProtection> protection;  // ten times a second

  void archive(auto& ar) { ar(static_cast<NavState&>(*this), odom, mount, protection); }
};

}  // namespace maploop
