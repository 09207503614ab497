// Another system's trajectory in the place of visual odometry.
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
  std::string file;              // poses of the left camera; empty: none
  double speed_sigma = 0.3;      // m/s, of a motion over its time; it lacks a figure of its own
  double rotation_sigma = 0.17;  // deg an axis, the same
};

// Poses of the left camera (x right, y down, z forward; m) as KITTI writes them: 3x4 a line, row by
// row, the frame's number before it or not (then one line a frame from 0). By frame; plain or .gz.
struct CameraPoses {
  std::vector<std::size_t> frames;
  std::vector<Eigen::Isometry3d> poses;
};

// Throws std::runtime_error naming file and line of what is no pose, or does not come after the
// line before; also where there are fewer than two.
CameraPoses read_camera_poses(const std::filesystem::path& file);

// One motion a pose, of the body, stamped by `stamps` (one for each frame of the recording) and
// available `delay` later. Throws std::runtime_error when a frame has no stamp.
std::unique_ptr<Source<RelativeMotion>> make_pose_odometry(std::shared_ptr<const CameraPoses> poses,
                                                           std::vector<Time> stamps,
                                                           const Eigen::Isometry3d& T_body_cam,
                                                           const PoseOdometryParameters& parameters,
                                                           Duration delay);

}  // namespace maploop::sensors
