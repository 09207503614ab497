// Computes absolute and relative pose errors (Sturm et al., "A Benchmark for the Evaluation of
// RGB-D SLAM Systems", IROS 2012; Zhang, Scaramuzza, "A Tutorial on Quantitative Trajectory
// Evaluation", IROS 2018).
#pragma once

#include <span>

#include "tools/evaluate/kitti_poses.h"

namespace maploop::evaluation {

struct Statistics {
  double rmse = 0.0, mean = 0.0, median = 0.0, max = 0.0;
};
Statistics statistics(std::vector<double> values);  // all zero if there are no values

// Returns the rigid motion that brings the estimate's positions nearest to the truth's (Umeyama
// 1991, no scale). Throws std::invalid_argument unless both have the same length of at least three
// poses.
Eigen::Isometry3d best_alignment(const Trajectory& estimate, const Trajectory& truth);

// Returns the APE: distance of the positions, m, one for each pose. `alignment` is applied to the
// estimate first.
std::vector<double> absolute_errors(const Trajectory& estimate, const Trajectory& truth,
                                    const Eigen::Isometry3d& alignment);

// The RPE from each pose to the next: m and degrees.
struct RelativeErrors {
  std::vector<double> translation_m;
  std::vector<double> rotation_deg;
};
RelativeErrors relative_errors(const Trajectory& estimate, const Trajectory& truth);

}  // namespace maploop::evaluation
