// Computes all scores of one trajectory against one truth.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/kitti_metric.h"
#include "tools/evaluate/pose_errors.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/web/plot.h"

namespace maploop::evaluation {

struct LengthError {
  double length_m = 0.0;
  SegmentError raw, common_rotation_removed;  // segments from every frame
};

struct Evaluation {
  Matched matched;
  Score raw, common_rotation_removed;
  SegmentError kitti;  // the benchmark's own score: 100 to 800 m, every tenth frame
  std::vector<LengthError> lengths;
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

// Return a path in metres right and ahead of its first camera, and the distance (m) to each pose,
// for pictures.
web::Line seen_from_above(const std::string& name, const Trajectory& trajectory);
std::vector<double> distances(const Trajectory& truth);

}  // namespace maploop::evaluation
