// Reads and writes trajectories in the KITTI odometry benchmark's pose format: one line for each
// frame, the upper 3x4 of the left camera's pose in row-major order, twelve numbers separated by
// blanks.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace maploop::evaluation {

// Poses of the left camera (x right, y down, z forward), metres, one for each frame, all in one
// fixed frame.
using Trajectory = std::vector<Eigen::Isometry3d>;

// Reads a plain or .gz file; empty lines are skipped. Throws std::runtime_error naming the file,
// and the line of a pose that does not have exactly twelve finite numbers or whose left 3x3 block
// is not a rotation (to 1e-3: files are rounded); also if the file cannot be read or contains no
// pose.
Trajectory read_kitti_poses(const std::filesystem::path& file);

// Reading the file returns bitwise equal numbers. Throws std::runtime_error naming the file if it
// cannot be written, std::invalid_argument if a pose is not finite.
void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace maploop::evaluation
