// This file defines a GNSS receiver's position and velocity.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "msgs/local_frame.h"
#include "msgs/sample.h"

namespace maploop {

// What a fix measures beyond the fix before and the vehicle's own motion since, by which its
// receiver was carried. A filter that knows both must use this in place of the fix, which contains
// them.
struct GnssIncrement {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();             // m, enu, from the fix's position
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2
  // m^2, by how much the motion has made the receiver's position less certain since the fix before.
  Eigen::Matrix3d growth = Eigen::Matrix3d::Zero();

  void archive(auto& ar) {
    ar(position, position_covariance, velocity_enu, velocity_covariance, growth);
  }
};

// This is a position and a velocity of a GNSS receiver. `stamp` is that of the position.
struct GnssFix : Sample {
  Geodetic position;                                              // of the antenna
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  Time velocity_stamp{};  // some receivers deliver a velocity older than their position
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();         // m/s
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  // m^2/s^2
  std::optional<GnssIncrement> increment;                         // of a receiver that is carried

  // Returns the fix as of a receiver that is not carried.
  GnssFix alone() const {
    GnssFix fix = *this;
    fix.increment.reset();
    return fix;
  }

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), position, position_covariance, velocity_stamp, velocity_enu,
       velocity_covariance, increment);
  }
};

}  // namespace maploop
