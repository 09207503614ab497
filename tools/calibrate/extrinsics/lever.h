// This file finds where sensors are in a vehicle from how they move when it turns.
#pragma once

#include <Eigen/Core>
#include <span>

#include "tools/calibrate/extrinsics/rate_alignment.h"
#include "tools/calibrate/extrinsics/rotation_stream.h"

namespace maploop::extrinsics {

// Where sensor b is in the axes of sensor a.
struct HandEye {
  bool found = false;  // there are motions to find it from
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  double scale = 1.0;  // lengths of a by those of b
  // Position, 1 sigma (m), and covariance of a rotation vector (rad^2), in a's axes.
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Constant(3.0);
  Eigen::Matrix3d rotation_covariance = Eigen::Matrix3d::Zero();
  double scale_sigma = 0.0;
};

// Solves A X = X B for the motions A, B of both sensors over two seconds (Tsai and Lenz, IEEE
// Trans. Robotics and Automation 5, 1989; here all at once): with X = (R, p), and b's lengths
// multiplied by s,
//   (R_A - I) p = s R p_B - p_A.
// Unknown are p, s and a small turn of R, which begins with the alignment of the rates and its
// standard deviations: on a straight road it is seen in the direction of travel, and p is not
// seen. What the turns do not show of p (the component along their axis) keeps 3 m of standard
// deviation. Odometry is wrong by 0.1 % of the way in step with the turns, which is part of p's
// standard deviation. The delay is that of the alignment, and is held.
HandEye hand_eye(std::span<const SensorMotion> a, std::span<const SensorMotion> b,
                 const RateAlignment& alignment);

// How a sensor moves with the vehicle.
struct Travel {
  bool found = false;
  double axle_distance = 0.0, axle_distance_sigma = 10.0;  // m, ahead of the rear axle
  // Direction of the axle's travel: to the left of the body's x, and above it; rad.
  double course = 0.0, course_sigma = 0.09;
  double climb = 0.0, climb_sigma = 0.09;
};

// The rear axle does not move sideways but for the slip of its tyres. So the velocity to the left
// of a sensor that is d ahead of it is, with forward velocity v and yaw rate w,
//   v_left = course v + d w - slip v^2 w,
// and upward, with pitch rate q (nose down), v_up = climb v - d' q. `slip` (rad/(m/s^2)) is known
// to `slip_sigma`. A car slips sideways by 0.002 rad that no model knows, which is part of the
// standard deviation of d: without turns d is not seen.
Travel travel_of(std::span<const SensorMotion> motions, const Eigen::Matrix3d& R_body_sensor,
                 double slip, double slip_sigma);

}  // namespace maploop::extrinsics
