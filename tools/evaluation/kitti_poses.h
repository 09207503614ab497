// Trajectories in the KITTI odometry benchmark's pose format: one line a frame, the upper 3x4 of
// the left camera's pose in row-major order, twelve numbers separated by blanks.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace maploop::evaluation {

// Poses of the left camera (x right, y down, z forward), metres, one a frame, all in one fixed
// frame.
using Trajectory = std::vector<Eigen::Isometry3d>;

// Plain or .gz; empty lines are skipped. Throws std::runtime_error naming the file, and the line of
// a pose that has not exactly twelve finite numbers or whose left 3x3 block is no rotation (to
// 1e-3: files are rounded); also when the file cannot be read or holds no pose.
Trajectory read_kitti_poses(const std::filesystem::path& file);

// Reading gives the same bits back. Throws std::runtime_error naming the file when it cannot be
// written, std::invalid_argument when a pose is not finite.
void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace maploop::evaluation
