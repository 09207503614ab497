// This file describes a vehicle and the mounting of its sensors.
#pragma once

#include <Eigen/Geometry>

namespace maploop {

// This is a rectified stereo pair: both cameras share the intrinsics, and the right camera is
// `baseline` to the right of the left one.
struct StereoCalibration {
  int width = 0;                                                 // px
  int height = 0;                                                // px
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;                 // px, focal lengths and center
  double baseline = 0.0;                                         // m
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();  // pose of the left camera

  void archive(auto& ar) { ar(width, height, fx, fy, cx, cy, baseline, T_body_cam); }
};

// Says what there is to combine with fixes.
struct FusedSensors {
  bool motion = false;    // of a camera, a LiDAR or wheels
  bool inertial = false;  // of a unit's accelerometers and gyros
  bool wheels = false;    // their speed is the only motion
  bool mems = true;       // the grade of the inertial unit is not known

  void archive(auto& ar) { ar(motion, inertial, wheels, mems); }
};

// This is what the estimators use of a vehicle's sensors. Unknown values default to those of no
// particular car.
struct VehicleCalibration {
  StereoCalibration stereo;  // the rectified cameras; width 0: there are none
  Eigen::Isometry3d T_body_velo = Eigen::Isometry3d::Identity();  // pose of the LiDAR
  double rear_axle_distance = 0.0;     // m, from the rear axle forward to the body's origin
  double climb_offset = 0.0;           // rad, direction of travel above body x, by mounting
  double climb_offset_sigma = 0.0175;  // rad (1 deg), of climb_offset
  double beam_elevation = 0.0;         // rad, the LiDAR's beams are higher than calibrated
  FusedSensors fused{true, true, true, false};  // a vehicle has all of them
  bool peer_reference = false;  // the reference is another fusion of the same sensors, not a truth

  void archive(auto& ar) {
    ar(stereo, T_body_velo, rear_axle_distance, climb_offset, climb_offset_sigma, beam_elevation,
       fused, peer_reference);
  }
};

}  // namespace maploop
