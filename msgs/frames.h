// This file defines frames and angles.
//
//   enu   x east, y north, z up at the drive's origin; metric WGS84
//   body  x forward, y left, z up (ISO 8855, REP-103); origin at the IMU
//   cam   left rectified camera: x right, y down, z forward
//   velo  LiDAR: x forward, y left, z up
//
// T_a_b maps coordinates in b to coordinates in a. yaw is counter-clockwise from east, azimuth is
// clockwise from north; pitch is nose-up positive, roll is right-side-down positive.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace maploop {

// Maps an angle to (-pi, pi], rad.
inline double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

// Converts a yaw to the azimuth of the same direction, in (-pi, pi], rad.
inline double azimuth_from_yaw(double yaw) {
  return wrap_angle(std::numbers::pi / 2.0 - yaw);
}
// Converts an azimuth to the yaw of the same direction, in (-pi, pi], rad.
inline double yaw_from_azimuth(double azimuth) {
  return wrap_angle(std::numbers::pi / 2.0 - azimuth);
}

// Converts deg to rad.
constexpr double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}
// Converts rad to deg.
constexpr double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

// This is the attitude of the body in ENU.
struct Attitude {
  double azimuth = 0.0;  // rad, clockwise from north
  double pitch = 0.0;    // rad, nose up
  double roll = 0.0;     // rad, right side down

  void archive(auto& ar) { ar(azimuth, pitch, roll); }
};

// R_enu_body = Rz(yaw) Ry(-pitch) Rx(roll): first yaw, then nose up, then right side down.
inline Eigen::Matrix3d rotation_enu_body(const Attitude& a) {
  return (Eigen::AngleAxisd(yaw_from_azimuth(a.azimuth), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(-a.pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(a.roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

// This is the inverse of rotation_enu_body for |pitch| < pi/2.
inline Attitude attitude_from_rotation(const Eigen::Matrix3d& R_enu_body) {
  return {azimuth_from_yaw(std::atan2(R_enu_body(1, 0), R_enu_body(0, 0))),
          std::asin(std::fmin(1.0, std::fmax(-1.0, R_enu_body(2, 0)))),
          std::atan2(R_enu_body(2, 1), R_enu_body(2, 2))};
}

}  // namespace maploop
