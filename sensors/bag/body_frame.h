// This file chooses the vehicle's body frame from the frames of a recording.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "sensors/bag/frame_tree.h"

namespace maploop::sensors {

// Names the frames of the sensors; empty: there is no such sensor. `force` is the unit's mean
// specific force in its own axes, m/s^2.
struct SensorFrames {
  std::string camera, lidar, imu;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

struct BodyFrame {
  // The camera frame is x right, y down, z forward, as its images are.
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_body_lidar = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Matrix3d> R_body_imu;  // nothing: it must be found on the way
  std::vector<std::string> notes;             // what was assumed
};

// Applies the rules of bag_recording.h.
BodyFrame choose_body_frame(const FrameTree& tree, const SensorFrames& sensors);

}  // namespace maploop::sensors
