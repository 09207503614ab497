// This file defines a visual motion with the data to correct it for wrong disparities.
#pragma once

#include "msgs/odometry.h"

namespace maploop {

struct VisualMotion : RelativeMotion {
  // This constant, px, was added to all disparities. Its standard deviation contributes by_offset *
  // by_offset^T * offset_sigma^2 to `covariance`.
  double offset = 0.0;
  double offset_sigma = 0.0;
  // Change of the motion for each added px: m, rad, in the axes of `covariance`. Zero if it is
  // unknown.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();

  void archive(auto& ar) {
    ar(static_cast<RelativeMotion&>(*this), offset, offset_sigma, by_offset);
  }
};

}  // namespace maploop
