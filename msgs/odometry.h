// Relative motion from one image (or scan) to the next.
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
  too_few_inliers,   // no motion explains enough of them
  implausible,       // the motion found is beyond what a road vehicle does
  bad_input,         // image size wrong, or time not increasing
};

constexpr std::size_t odometry_status_count =
    static_cast<std::size_t>(OdometryStatus::bad_input) + 1;

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
    case OdometryStatus::implausible:
      return "implausible motion";
    case OdometryStatus::bad_input:
      return "bad input";
  }
  return "unknown";
}

// Pose of the body at `stamp` in the body frame at `from`. Sent for every input: where there is no
// motion to report, `status` says why and the pose is not to be used.
struct RelativeMotion : Sample {
  OdometryStatus status = OdometryStatus::first_frame;
  Time from{};
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         // m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // unit
  // Of the body at `stamp`: translation (m), then rotation vector (rad), both in the body frame at
  // `from`.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int tracked = 0;  // features offered to the motion estimate
  int inliers = 0;  // features that agree with it

  Eigen::Isometry3d T_from_to() const { return Eigen::Translation3d(translation) * rotation; }
};

template <class Archive>
void archive(Archive& ar, RelativeMotion& m) {
  ar(static_cast<Sample&>(m), m.status, m.from, m.translation, m.rotation, m.covariance, m.tracked,
     m.inliers);
}

}  // namespace maploop
