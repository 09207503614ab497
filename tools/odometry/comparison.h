// Compares methods of matching and of motion estimation on the same frames (the thesis's figures
// 3.10 and 3.15).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "estimators/stereo/methods.h"
#include "tools/evaluate/evaluation.h"
#include "tools/odometry/consistency.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

struct Variant {
  std::string name;
  stereo::Matching matching = stereo::Matching::klt;
  stereo::MotionMethod motion = stereo::MotionMethod::points_to_image;
  int window_frames = 0;
  Disparities disparities = Disparities::own;
};

// Returns tracking against matching, the three methods of motion estimation, the window, and the
// sources of the disparity correction. Recorded tracks have no images to match in (`images`), and
// not every drive has scans (`scans`).
std::vector<Variant> variants(bool images, bool scans);

struct VariantResult {
  Variant variant;
  int pairs = 0, refused = 0;
  double tracks = 0.0;        // per pair, mean
  double life = 0.0;          // pairs over which a feature is tracked, mean
  double inlier_ratio = 0.0;  // mean over the pairs that were not refused
  double milliseconds = 0.0;  // per pair, median
  Consistency consistency;    // for increments of one second
  evaluation::Evaluation score;
};

// Runs one variant; the other parameters come from `config`. One camera cannot observe the length
// of its motions: they are scaled to the lengths of `truth`, and only their directions are
// estimated.
VariantResult run_variant(const Variant& variant, const std::filesystem::path& input,
                          const std::filesystem::path& config, FrameRange frames,
                          const evaluation::StampedTrajectory& truth);

std::string to_text(const std::vector<VariantResult>& results);
// Returns a page with the table, the paths seen from above, and the errors along the way.
std::string to_html(const std::vector<VariantResult>& results, const std::string& heading);

}  // namespace maploop::odometry
