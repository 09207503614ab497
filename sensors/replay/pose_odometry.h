// This file replaces visual odometry by another system's trajectory.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "msgs/odometry.h"
#include "sensors/source.h"

namespace maploop::sensors {

struct PoseOdometryParameters {
  std::string file;
  double speed_sigma = 0.3;      // m/s
  double rotation_sigma = 0.17;  // deg
};

// Holds poses of the left camera (x right, y down, z forward; m) in the form in which KITTI writes
// them: 3x4 a line, row by row, with the frame's number before it or without (then one line a frame
// from 0). Ordered by frame; plain or .gz.
struct CameraPoses {
  std::vector<std::size_t> frames;
  std::vector<Eigen::Isometry3d> poses;
};

// Returns the pose of twelve numbers. Throws std::invalid_argument if its left 3x3 block is not a
// rotation (to 1e-3).
Eigen::Isometry3d camera_pose(const double* numbers);

// Throws std::runtime_error that names file and line if a line is not a pose or does not follow the
// previous line in order, and also if there are fewer than two.
CameraPoses read_camera_poses(const std::filesystem::path& file);

// Returns one motion of the body for each pose, stamped by `stamps` (one for each frame of the
// recording) and available `delay` later. Throws std::runtime_error if a frame has no stamp.
std::unique_ptr<Source<RelativeMotion>> make_pose_odometry(std::shared_ptr<const CameraPoses> poses,
                                                           std::vector<Time> stamps,
                                                           const Eigen::Isometry3d& T_body_cam,
                                                           const PoseOdometryParameters& parameters,
                                                           Duration delay);

}  // namespace maploop::sensors
