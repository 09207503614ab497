// Computes all scores of one trajectory against one truth: KITTI's metric, and absolute and
// relative pose errors (Sturm et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS
// 2012; Zhang, Scaramuzza, "A Tutorial on Quantitative Trajectory Evaluation", IROS 2018).
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/kitti_metric.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/web/plot.h"

namespace maploop::evaluation {

struct Statistics {
  double rmse = 0.0, mean = 0.0, median = 0.0, max = 0.0;
  double p95 = 0.0;
};

// All figures are zero if there are no values.
Statistics statistics(std::vector<double> values);

// Returns the value that `share` of all are at most, between two of them by their distance.
// Precondition: there are values, in increasing order.
double quantile(const std::vector<double>& sorted, double share);

struct LengthError {
  double length_m = 0.0;
  SegmentError raw, common_rotation_removed;  // segments from every frame
};

// The errors of each pose.
struct PoseErrors {
  std::vector<double> along;       // m, way along the truth
  std::vector<double> from_start;  // m, position, if both start at the same pose
  std::vector<double> aligned;     // m, position after the best rigid alignment (APE)
  // From each pose to the next (RPE), one fewer than poses.
  std::vector<double> step_m, step_deg;
};

struct Evaluation {
  Matched matched;
  Score raw, common_rotation_removed;
  SegmentError kitti;  // the benchmark's own score: 100 to 800 m, every tenth frame
  std::vector<LengthError> lengths;
  PoseErrors errors;
  Statistics ape;             // m, after the best rigid alignment
  Statistics rpe_m, rpe_deg;  // from pose to pose
};

// Throws std::invalid_argument if fewer than three poses match or a length is not positive.
Evaluation evaluate(Matched matched, const std::vector<double>& lengths_m);

std::string to_text(const Evaluation& evaluation);

// Returns one line for each pose, with a heading: stamp (s; empty without), way (m along the
// truth), error from the start and after the best alignment (m), and from the previous pose (m,
// deg).
std::string to_csv(const Evaluation& evaluation);

// Returns a page with the table, the two paths seen from above, and the errors along the way.
std::string to_html(const Evaluation& evaluation, const std::string& heading);

// Returns a path in metres right and ahead of its first camera, for pictures.
web::Line seen_from_above(const std::string& name, const Trajectory& trajectory);

}  // namespace maploop::evaluation
