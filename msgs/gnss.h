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
};

template <class Archive>
void archive(Archive& ar, GnssFix& f) {
  ar(static_cast<Sample&>(f), f.position, f.position_covariance, f.velocity_stamp, f.velocity_enu,
     f.velocity_covariance);
}

}  // namespace maploop
