// This file defines a visual motion with the data to correct it for wrong disparities.
#pragma once

#include "msgs/odometry.h"

namespace maploop {

// This is the motion of stereo odometry, and how it depends on a constant error of all disparities.
struct VisualMotion : RelativeMotion {
  // This constant, px, was added to all disparities. Its standard deviation contributes by_offset *
  // by_offset^T * offset_sigma^2 to `covariance`.
  double offset = 0.0;
  double offset_sigma = 0.0;  // px, standard deviation of `offset`
  // Change of the motion for each added px: m, rad, in the axes of `covariance`. Zero if it is
  // unknown.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();

  void archive(auto& ar) {
    ar(static_cast<RelativeMotion&>(*this), offset, offset_sigma, by_offset);
  }
};

}  // namespace maploop
