// This file defines relative motion from one image (or scan) to the next.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "msgs/sample.h"

namespace maploop {

enum class OdometryStatus : std::uint8_t {
  ok,
  first_frame,       // nothing to compare with yet
  too_few_features,  // not enough tracked features with a valid stereo match
  too_few_inliers,   // no motion explains enough features
  too_dark,          // too few features because there is too little light
  swapped_images,    // too few features because left and right are exchanged
  repeated_image,    // the pixels of the previous image under a new stamp
  moving_objects,    // most features agree on a motion that is not the vehicle's
  implausible,       // the motion found is beyond what a road vehicle does
  bad_input,         // image size wrong, or time not increasing
  not_converged,     // the registration of a scan had not settled when it had to end
  disagreement,      // LiDAR and visual motion contradict each other
};

constexpr std::size_t odometry_status_count =
    static_cast<std::size_t>(OdometryStatus::disagreement) + 1;

constexpr std::string_view to_string(OdometryStatus status) {
  switch (status) {
    case OdometryStatus::ok:
      return "ok";
    case OdometryStatus::first_frame:
      return "first frame";
    case OdometryStatus::too_few_features:
      return "too few features";
    case OdometryStatus::too_few_inliers:
      return "too few inliers";
    case OdometryStatus::too_dark:
      return "too dark";
    case OdometryStatus::swapped_images:
      return "left and right images swapped";
    case OdometryStatus::repeated_image:
      return "repeated image";
    case OdometryStatus::moving_objects:
      return "moving objects dominate";
    case OdometryStatus::implausible:
      return "implausible motion";
    case OdometryStatus::bad_input:
      return "bad input";
    case OdometryStatus::not_converged:
      return "not converged";
    case OdometryStatus::disagreement:
      return "LiDAR and visual motion disagree";
  }
  return "unknown";
}

// States additional information about a usable motion.
enum class OdometryCondition : std::uint8_t {
  ordinary,
  standstill,  // the images do not move
  after_gap,   // spans inputs that were lost or refused
};

constexpr std::size_t odometry_condition_count =
    static_cast<std::size_t>(OdometryCondition::after_gap) + 1;

constexpr std::string_view to_string(OdometryCondition condition) {
  switch (condition) {
    case OdometryCondition::ordinary:
      return "ordinary";
    case OdometryCondition::standstill:
      return "standstill";
    case OdometryCondition::after_gap:
      return "after a gap";
  }
  return "unknown";
}

enum class OdometrySource : std::uint8_t {
  visual,
  lidar,
  visual_lidar,  // LiDAR seeded by the visual motion
};
constexpr std::size_t odometry_source_count =
    static_cast<std::size_t>(OdometrySource::visual_lidar) + 1;

// These are directions of the body, in the order of a motion's components.
enum class MotionDirection : std::uint8_t { along, across, up, roll, pitch, yaw };

constexpr std::string_view to_string(MotionDirection direction) {
  constexpr std::string_view names[] = {"along", "across", "up", "roll", "pitch", "yaw"};
  return names[static_cast<std::size_t>(direction)];
}

// This is the pose of the body at `stamp` in the body frame at `from`. It is sent for every input:
// if there is no motion to report, `status` states why and the pose must not be used.
struct RelativeMotion : Sample {
  OdometryStatus status = OdometryStatus::first_frame;
  OdometryCondition condition = OdometryCondition::ordinary;
  double parallax = 0.0;  // px, median image motion without the rotation's part; LiDAR: 0
  Time from{};
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         // m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit
  // Covariance of the body's pose at `stamp`: translation (m), then rotation vector (rad), both in
  // the body frame at `from`.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int tracked = 0;  // features (LiDAR: surface points) offered to the motion estimate
  int inliers = 0;  // those that agree with it (LiDAR: have a partner in the map)
  OdometrySource source = OdometrySource::visual;

  Eigen::Isometry3d T_from_to() const { return Eigen::Translation3d(translation) * rotation; }
};

template <class Archive>
void archive(Archive& ar, RelativeMotion& m) {
  ar(static_cast<Sample&>(m), m.status, m.condition, m.parallax, m.from, m.translation, m.rotation,
     m.covariance, m.tracked, m.inliers, m.source);
}

// This adds the result of a scan's registration. LiDAR odometry sends one for every scan.
struct LidarMotion : RelativeMotion {
  std::uint8_t degenerate = 0;          // bit MotionDirection: undetermined, the seed's is kept
  int iterations = 0;                   // of the registration
  double seed_translation_error = 0.0;  // m, change of the seed by the registration
  double seed_rotation_error = 0.0;     // rad
};

template <class Archive>
void archive(Archive& ar, LidarMotion& m) {
  ar(static_cast<RelativeMotion&>(m), m.degenerate, m.iterations, m.seed_translation_error,
     m.seed_rotation_error);
}

}  // namespace maploop
