// This file defines the antenna's motion as the vehicle's other sensors have measured it.
#pragma once

#include <Eigen/Core>

namespace maploop::ppp {

// From the epoch before to this one, earth-fixed. Its length and its direction about the vertical
// may have errors that last, which the filter estimates.
struct CarriedMotion {
  double interval = 0.0;                                   // s
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // m/s, at this epoch
  double turn_sigma = 0.0;   // rad, of the error of its direction that lasts, as its source states
  double lever_sigma = 0.0;  // m, of the displacement, horizontally, by the place of the antenna
};

}  // namespace maploop::ppp
