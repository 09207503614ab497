// Compares methods of matching and of motion estimation on the same frames (the thesis's figures
// 3.10 and 3.15).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "estimators/stereo/methods.h"
#include "tools/odometry/comparison.h"
#include "tools/odometry/odometry_input.h"
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

// Returns the table without a variant. Its columns are, a pair: tracks; pairs over which a feature
// is tracked; inliers, of the pairs that were not refused; errors; NEES of increments of a second.
Comparison stereo_comparison();

// Runs one variant; the other parameters come from the configuration. One camera cannot observe the
// length of its motions: they are scaled to the lengths of `truth`, and only their directions are
// estimated.
Compared run_variant(const Variant& variant, const InputFiles& files, FrameRange frames,
                     const evaluation::StampedTrajectory& truth);

}  // namespace maploop::odometry
