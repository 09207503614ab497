// Trajectories with stamps, in the formats that odometries are exchanged in.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/time.h"
#include "tools/evaluation/kitti_poses.h"

namespace maploop::evaluation {

// Poses of the left camera; `stamps` is empty (the format has none) or has one for each.
struct StampedTrajectory {
  std::vector<Time> stamps;
  Trajectory poses;
};

// Plain or .gz, told apart by what the file holds:
//   KITTI   12 numbers a line, no stamps (kitti_poses.h)
//   TUM     stamp x y z qx qy qz qw, seconds; lines that start with # are skipped
//   CSV     recorded truth: a heading that names t, cam_x ... cam_z, cam_qw ... cam_qz
// Throws std::runtime_error naming file and line where a line is not of the format, a quaternion is
// not of length one (to 1e-3), or the stamps do not increase.
StampedTrajectory read_trajectory(const std::filesystem::path& file);

// Nanoseconds are kept. Throws std::runtime_error naming the file when it cannot be written.
void write_tum(const std::filesystem::path& file, const StampedTrajectory& trajectory);

// Poses of both at the same moments: stamps no further apart than `tolerance`, each used once;
// frame by frame where one of them has no stamps.
struct Matched {
  std::vector<Time> stamps;  // the estimate's, or empty
  Trajectory estimate;
  Trajectory truth;
  std::size_t unmatched_estimate = 0, unmatched_truth = 0;  // poses without a partner
};
Matched match(const StampedTrajectory& estimate, const StampedTrajectory& truth,
              Duration tolerance);

}  // namespace maploop::evaluation
