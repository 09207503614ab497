// These functions measure the error of a trajectory against the truth.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace maploop::testing {

using Trajectory = std::vector<Eigen::Isometry3d>;

inline double horizontal_end_error(const Trajectory& estimate, const Trajectory& truth) {
  return (estimate.back().translation() - truth.back().translation()).head<2>().norm();
}

struct SegmentError {
  double translation = std::numeric_limits<double>::quiet_NaN();  // % of the length
  double rotation = std::numeric_limits<double>::quiet_NaN();     // deg/m
  int segments = 0;
};

// Returns KITTI's measure: the mean error of the relative pose over segments of `length` metres
// that start at every pose.
inline SegmentError segment_error(const Trajectory& estimate, const Trajectory& truth,
                                  double length) {
  std::vector<double> travelled{0.0};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    travelled.push_back(travelled.back() +
                        (truth[i].translation() - truth[i - 1].translation()).norm());
  }
  SegmentError sum{0.0, 0.0, 0};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto end = std::lower_bound(travelled.begin(), travelled.end(), travelled[i] + length);
    if (end == travelled.end()) break;
    const auto j = static_cast<std::size_t>(end - travelled.begin());
    const Eigen::Isometry3d error =
        (estimate[i].inverse() * estimate[j]).inverse() * (truth[i].inverse() * truth[j]);
    sum.translation += 100.0 * error.translation().norm() / length;
    sum.rotation += Eigen::AngleAxisd(error.rotation()).angle() * 180.0 / std::numbers::pi / length;
    ++sum.segments;
  }
  if (sum.segments == 0) return {};
  return {sum.translation / sum.segments, sum.rotation / sum.segments, sum.segments};
}

}  // namespace maploop::testing
