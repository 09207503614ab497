// This file defines relative motion from one image (or scan) to the next.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop {

// States whether there is a usable motion, and otherwise why not.
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

constexpr auto names_of(OdometryStatus) {
  return names_up_to<OdometryStatus::disagreement>(
      {"ok", "first frame", "too few features", "too few inliers", "too dark",
       "left and right images swapped", "repeated image", "moving objects dominate",
       "implausible motion", "bad input", "not converged", "LiDAR and visual motion disagree"});
}

// States additional information about a usable motion.
enum class OdometryCondition : std::uint8_t {
  ordinary,
  standstill,  // the images do not move
  after_gap,   // spans inputs that were lost or refused
};

constexpr auto names_of(OdometryCondition) {
  return names_up_to<OdometryCondition::after_gap>({"ordinary", "standstill", "after a gap"});
}

// Names the sensors that a motion is from.
enum class OdometrySource : std::uint8_t {
  visual,
  lidar,
  visual_lidar,  // LiDAR seeded by the visual motion
};

constexpr auto names_of(OdometrySource) {
  return names_up_to<OdometrySource::visual_lidar>({"visual", "lidar", "visual-lidar"});
}
// These are directions of the body, in the order of a motion's components.
enum class MotionDirection : std::uint8_t { along, across, up, roll, pitch, yaw };

constexpr auto names_of(MotionDirection) {
  return names_up_to<MotionDirection::yaw>({"along", "across", "up", "roll", "pitch", "yaw"});
}

// This is the pose of the body at `stamp` in the body frame at `from`. It is sent for every input:
// if there is no motion to report, `status` states why and the pose must not be used.
struct RelativeMotion : Sample {
  OdometryStatus status = OdometryStatus::first_frame;        // ok: the pose may be used
  OdometryCondition condition = OdometryCondition::ordinary;  // of a usable motion
  double parallax = 0.0;  // px, median image motion without the rotation's part; LiDAR: 0
  Time from{};            // stamp of the earlier image or scan
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         // m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit
  // Covariance of the body's pose at `stamp`: translation (m), then rotation vector (rad), both in
  // the body frame at `from`.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int tracked = 0;  // features (LiDAR: surface points) offered to the motion estimate
  int inliers = 0;  // those that agree with it (LiDAR: have a partner in the map)
  OdometrySource source = OdometrySource::visual;  // the sensors that it is from

  // Returns the pose of the body at `stamp` in the body frame at `from`.
  Eigen::Isometry3d T_from_to() const { return Eigen::Translation3d(translation) * rotation; }

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), status, condition, parallax, from, translation, rotation,
       covariance, tracked, inliers, source);
  }
};

// This adds the result of a scan's registration. LiDAR odometry sends one for every scan.
struct LidarMotion : RelativeMotion {
  std::uint8_t degenerate = 0;          // bit MotionDirection: undetermined, the seed's is kept
  int iterations = 0;                   // of the registration
  double seed_translation_error = 0.0;  // m, change of the seed by the registration
  double seed_rotation_error = 0.0;     // rad, the same of its rotation

  void archive(auto& ar) {
    ar(static_cast<RelativeMotion&>(*this), degenerate, iterations, seed_translation_error,
       seed_rotation_error);
  }
};

}  // namespace maploop
