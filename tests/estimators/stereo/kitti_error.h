// KITTI's segment error of a trajectory.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace maploop::testing {

using Trajectory = std::vector<Eigen::Isometry3d>;

struct SegmentError {
  double translation = 0.0;  // mean over segments, fraction of the length
  double rotation = 0.0;     // mean, rad per m
  double end_point = 0.0;    // m
  double distance = 0.0;     // m along the truth
  int segments = 0;
};

// Every start, one length (Geiger, Lenz and Urtasun, "Are we ready for autonomous driving? The
// KITTI vision benchmark suite", CVPR 2012).
SegmentError kitti_error(const Trajectory& estimate, const Trajectory& truth, double length);

// The estimate seen from a frame turned by the one constant rotation between the two systems'
// axes, fitted on 25 m segments: what a wrong mounting angle of the reference would do.
Trajectory without_common_rotation(const Trajectory& estimate, const Trajectory& truth);

// Rows of 12 numbers. Throws std::runtime_error naming the file.
Trajectory read_kitti_poses(const std::filesystem::path& file);

}  // namespace maploop::testing
