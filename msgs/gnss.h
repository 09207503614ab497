// This file defines a GNSS receiver's position and velocity.
#pragma once

#include <Eigen/Core>

#include "msgs/local_frame.h"
#include "msgs/sample.h"

namespace maploop {

// `stamp` is that of the position.
struct GnssFix : Sample {
  Geodetic position;
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  Time velocity_stamp{};  // some receivers deliver a velocity older than their position
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), position, position_covariance, velocity_stamp, velocity_enu,
       velocity_covariance);
  }
};

}  // namespace maploop
