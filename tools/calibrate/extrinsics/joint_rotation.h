// This file joins what pairs of sensors say of each other's rotation.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace maploop::extrinsics {

enum class Part : std::uint8_t { body, camera, lidar };

struct MeasuredRotation {
  Part a = Part::body, b = Part::body;
  Eigen::Matrix3d R_a_b = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // rad^2, of a turn in a's axes
};

// The body's x axis points along the travel of its rear axle on a straight road, but for how well
// the inertial unit is mounted.
struct MeasuredTravel {
  Part sensor = Part::camera;
  Eigen::Vector3d in_body = Eigen::Vector3d::UnitX();    // as it is known
  Eigen::Vector3d in_sensor = Eigen::Vector3d::UnitX();  // as it is measured
  double left_sigma = 0.0, up_sigma = 0.0;               // rad, of both together
};

struct JointRotation {
  Eigen::Matrix3d R_body_camera = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_body_lidar = Eigen::Matrix3d::Identity();
  // Turns in the body's axes (rad^2), the camera's, then the LiDAR's.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double contradiction = 0.0;  // chi^2 of what is measured, by its redundancy; 1 is expected
};

// Returns the rotations for which the weighted sum of squares is least, begun at `start` with ten
// degrees of standard deviation. A contradiction above 1 enlarges the covariance.
JointRotation join(const std::vector<MeasuredRotation>& rotations,
                   const std::optional<MeasuredTravel>& travel, const JointRotation& start);

}  // namespace maploop::extrinsics
