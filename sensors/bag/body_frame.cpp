#include "sensors/bag/body_frame.h"

#include <cmath>
#include <string_view>

#include "msgs/frames.h"
#include "msgs/vehicle_description.h"

namespace maploop::sensors {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// These are how far axes may lean and point aside: hills, and mounts that are nearly right.
const double level = std::cos(radians(20.0)), ahead = std::cos(radians(30.0));

// Returns the rotation from the axes x forward, y left, z up to those of a camera.
Matrix3d camera_axes() {
  return camera_pose({}, {}).linear();
}

struct Axes {
  std::string frame;
  Matrix3d R_body_frame = Matrix3d::Identity();
};

bool points_up(const Vector3d& force) {
  return force.z() > level * force.norm() && force.norm() > 0.0;
}

// Whether x of the unit points where the camera or the LiDAR looks.
bool points_ahead(const FrameTree& tree, const SensorFrames& s) {
  const auto T_imu_camera = s.camera.empty() ? std::nullopt : tree.find(s.imu, s.camera);
  if (T_imu_camera) return T_imu_camera->linear()(0, 2) > ahead;
  const auto T_imu_lidar = s.lidar.empty() ? std::nullopt : tree.find(s.imu, s.lidar);
  return T_imu_lidar && T_imu_lidar->linear()(0, 0) > ahead;
}

std::optional<Axes> axes_of(const FrameTree& tree, const SensorFrames& s) {
  for (const char* base : {"base_link", "base_footprint"}) {
    for (const std::string* sensor : {&s.camera, &s.lidar, &s.imu})
      if (!sensor->empty() && tree.find(base, *sensor)) return Axes{base};
  }
  if (!s.imu.empty() && points_up(s.force) && points_ahead(tree, s)) return Axes{s.imu};
  if (!s.lidar.empty()) return Axes{s.lidar};
  if (!s.camera.empty()) return Axes{s.camera, camera_axes()};
  return std::nullopt;
}

}  // namespace

BodyFrame choose_body_frame(const FrameTree& tree, const SensorFrames& s) {
  BodyFrame body;
  body.T_body_camera.linear() = camera_axes();
  const auto axes = axes_of(tree, s);
  if (!axes) return body;
  Isometry3d T_body_axes(axes->R_body_frame);
  const auto T_axes_imu = s.imu.empty() ? std::nullopt : tree.find(axes->frame, s.imu);
  if (T_axes_imu) T_body_axes.translation() = -(axes->R_body_frame * T_axes_imu->translation());
  const auto place = [&](const std::string& frame, const char* name, const char* table,
                         Isometry3d& T_body_sensor) {
    if (frame.empty()) return;
    if (const auto found = tree.find(axes->frame, frame)) {
      T_body_sensor = T_body_axes * *found;
      return;
    }
    body.notes.push_back("No transform joins the frame '" + frame + "' of the " + name + " to '" +
                         axes->frame + "': the " + name +
                         " is taken to look forward from the body's origin; " + table +
                         " of the configuration can place it.");
  };
  place(s.camera, "camera", "[vehicle.camera]", body.T_body_camera);
  place(s.lidar, "LiDAR", "[vehicle.lidar]", body.T_body_lidar);
  if (s.imu.empty()) return body;
  if (T_axes_imu) {
    const Matrix3d R_body_imu = T_body_axes.linear() * T_axes_imu->linear();
    if (s.force.isZero() || points_up(R_body_imu * s.force)) {
      body.R_body_imu = R_body_imu;
      return body;
    }
    body.notes.push_back("The transforms turn the inertial unit '" + s.imu +
                         "' so that its specific force does not point up; its mount is found from "
                         "the fixes on the way, or stated by [vehicle.imu].");
    return body;
  }
  body.notes.push_back("No transform joins the frame '" + s.imu + "' of the inertial unit to '" +
                       axes->frame +
                       "'; its mount is found from the fixes on the way, or stated by "
                       "[vehicle.imu].");
  return body;
}

}  // namespace maploop::sensors
