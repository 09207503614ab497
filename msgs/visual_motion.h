// A visual motion with what is needed to correct it for wrong disparities.
#pragma once

#include "msgs/odometry.h"

namespace maploop {

struct VisualMotion : RelativeMotion {
  // Constant that was added to all disparities, px; the part of `covariance` that its standard
  // deviation makes is by_offset * by_offset^T * offset_sigma^2.
  double offset = 0.0;
  double offset_sigma = 0.0;
  // What the motion changes by where a px more is added: m, rad, in the axes of `covariance`. Zero
  // where that is not known.
  Eigen::Matrix<double, 6, 1> by_offset = Eigen::Matrix<double, 6, 1>::Zero();
};

template <class Archive>
void archive(Archive& ar, VisualMotion& m) {
  ar(static_cast<RelativeMotion&>(m), m.offset, m.offset_sigma, m.by_offset);
}

}  // namespace maploop
