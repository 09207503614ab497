// This function finds the point of a segment that is nearest to a place.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace maploop::mapmatch {

// Returns the share of the segment from `a` to `a + step`, 0 to 1, at which its nearest point to
// `place` is; 0 for a segment without length.
inline double foot_share(const Eigen::Vector2d& place, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& step) {
  const double squared = step.squaredNorm();
  return squared > 0.0 ? std::clamp((place - a).dot(step) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace maploop::mapmatch
