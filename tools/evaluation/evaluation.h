// Everything that is said of one trajectory against one truth.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluation/kitti_metric.h"
#include "tools/evaluation/pose_errors.h"
#include "tools/evaluation/trajectory_file.h"

namespace maploop::evaluation {

struct LengthError {
  double length_m = 0.0;
  SegmentError raw, common_rotation_removed;  // segments from every frame
};

struct Evaluation {
  Matched matched;
  Score raw, common_rotation_removed;
  SegmentError kitti;  // the benchmark's own: 100 to 800 m, every tenth frame
  std::vector<LengthError> lengths;
  Statistics ape;             // m, after the best rigid alignment
  Statistics rpe_m, rpe_deg;  // from pose to pose
};

// Throws std::invalid_argument where fewer than three poses match or a length is not positive.
Evaluation evaluate(Matched matched, const std::vector<double>& lengths_m);

std::string to_text(const Evaluation& evaluation);

// A page with the table, the two paths seen from above, and the errors along the way.
std::string to_html(const Evaluation& evaluation, const std::string& heading);

}  // namespace maploop::evaluation
