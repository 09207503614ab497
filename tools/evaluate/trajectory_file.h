// Reads and writes trajectories with stamps, in common formats.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/time.h"
#include "tools/evaluate/kitti_poses.h"

namespace maploop::evaluation {

// Poses of the left camera; `stamps` is empty (if the format has none) or has one for each pose.
struct StampedTrajectory {
  std::vector<Time> stamps;
  Trajectory poses;
};

// Reads a plain or .gz file; the format is recognized from the contents:
//   KITTI   12 numbers a line, no stamps (kitti_poses.h)
//   TUM     stamp x y z qx qy qz qw, seconds; lines that start with # are skipped
//   CSV     recorded truth: a heading with the columns t, cam_x ... cam_z, cam_qw ... cam_qz
// Throws std::runtime_error naming file and line if a line does not have the format, a quaternion
// does not have length one (to 1e-3), or the stamps do not increase.
StampedTrajectory read_trajectory(const std::filesystem::path& file);

// Nanoseconds are kept. Throws std::runtime_error naming the file if it cannot be written.
void write_tum(const std::filesystem::path& file, const StampedTrajectory& trajectory);

// Poses of both trajectories at the same times: their stamps differ by at most `tolerance`, and
// each pose is used once. If one trajectory has no stamps, poses are matched frame by frame.
struct Matched {
  std::vector<Time> stamps;  // the estimate's, or empty
  Trajectory estimate;
  Trajectory truth;
  std::size_t unmatched_estimate = 0, unmatched_truth = 0;  // poses without a partner
};
Matched match(const StampedTrajectory& estimate, const StampedTrajectory& truth,
              Duration tolerance);

}  // namespace maploop::evaluation
