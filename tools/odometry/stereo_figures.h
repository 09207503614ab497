// Figures of visual odometry that ran alone, against a truth.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "msgs/calibration.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Gives a motion of one camera, which cannot observe its length, that of the truth: of such a
// motion the direction alone is estimated.
void give_true_length(const StereoCalibration& camera, const evaluation::StampedTrajectory& truth,
                      RelativeMotion& motion);

// Returns, a pair: tracks and processor time; pairs over which a feature is tracked; inliers, of
// the pairs that were not refused; errors of the path, "turned" with one common rotation between
// the truth's axes and the camera's removed; NEES of increments of a second, of one degree of
// freedom. Throws std::runtime_error if there are no two frames.
nlohmann::json stereo_figures(const std::vector<Step>& steps,
                              const evaluation::StampedTrajectory& path,
                              const StereoCalibration& camera,
                              const evaluation::StampedTrajectory& truth);

}  // namespace maploop::odometry
