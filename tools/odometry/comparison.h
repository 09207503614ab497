// Ways to match and to find the motion, on the same frames (the thesis's figures 3.10 and 3.15).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "estimators/stereo/methods.h"
#include "tools/evaluation/evaluation.h"
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

// Tracking against matching, the three ways to find the motion, the window, and who says what the
// disparities lack. Recorded tracks have no images to match in, and not every drive has scans.
std::vector<Variant> variants(bool images, bool scans);

struct VariantResult {
  Variant variant;
  int pairs = 0, refused = 0;
  double tracks = 0.0;        // a pair, mean
  double life = 0.0;          // pairs that a feature is followed over, mean
  double inlier_ratio = 0.0;  // mean over the pairs that were not refused
  double milliseconds = 0.0;  // a pair, median
  Consistency consistency;    // of increments of one second
  evaluation::Evaluation score;
};

// Runs one variant with the other parameters as `config` says. One camera does not see how far it
// goes: its motions are given the lengths that `truth` has, and only their directions are its own.
VariantResult run_variant(const Variant& variant, const std::filesystem::path& input,
                          const std::filesystem::path& config, FrameRange frames,
                          const evaluation::StampedTrajectory& truth);

std::string to_text(const std::vector<VariantResult>& results);
// A page with the table, the paths seen from above, and the errors along the way.
std::string to_html(const std::vector<VariantResult>& results, const std::string& heading);

}  // namespace maploop::odometry
