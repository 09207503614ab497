// This file parses KITTI's calibration texts ("KEY: numbers").
#pragma once

#include <filesystem>
#include <string_view>

#include "msgs/calibration.h"
#include "msgs/vehicle_description.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/replay/keyed_text.h"

namespace maploop::sensors {

// These are the texts of the three files, each with the name that errors give it.
struct KittiCalibrationText {
  std::string_view cam_to_cam, velo_to_cam, imu_to_velo;
  std::filesystem::path cam_to_cam_file, velo_to_cam_file, imu_to_velo_file;
};

// Returns the rectified grey cameras (00 left, 01 right) and the LiDAR in the body frame, which is
// the IMU's. Geiger, Lenz, Stiller, Urtasun, "Vision meets Robotics: The KITTI Dataset", IJRR 2013,
// eq. 3 to 8:
//   T_cam_imu = R_rect_00 T_cam0_velo T_velo_imu,   baseline = -P_rect_01(0,3) / P_rect_01(0,0)
// The printed rotations, rounded to seven digits, are replaced by the nearest true ones. Throws
// std::runtime_error that names file and key: missing or given twice, not the right count of finite
// numbers, not a rotation (to 1e-3), cameras that do not form a rectified pair.
//
// If the calib_time is that of KITTI's own IMU, the known properties of KITTI's car are added; a
// drive of another car in KITTI's layout gets none of them.
VehicleCalibration parse_kitti_calibration(const KittiCalibrationText& text);

// KITTI's car travels 0.48 deg (0.0084 rad) above its IMU's x axis: mean of eight odometry
// sequences (0.14 to 0.86 deg). Its IMU is 0.25 m ahead of the point that moves without side slip:
// sideways velocity over yaw rate on five of them (0.23 to 0.29 m). Its HDL-64E's beams point 0.205
// deg higher than its calibration states (IMLS-SLAM, CT-ICP, KISS-ICP use the same).
void describe_kitti_car(VehicleCalibration& calibration);

// Adds the standard deviations of these values, from the spread that is stated above, where the
// calibration has them; and what else its description needs. Its GNSS positions are those of the
// inertial unit, whose rates are 53 to 67 ms late.
void describe_kitti_car(const VehicleCalibration& calibration, VehicleDescription& description);

// Returns the rectified pair of S_rect, P_rect of 00 and 01; T_body_cam is not set.
StereoCalibration parse_rectified_pair(const KeyedText& text);

// Reads calib_cam_to_cam.txt, calib_velo_to_cam.txt, calib_imu_to_velo.txt in `folder`. Throws as
// above, and if a file is missing.
VehicleCalibration read_kitti_calibration(const std::filesystem::path& folder);

// Does the same for raw cameras: calib_cam_to_cam.txt is not read; the two others are read only if
// there is a scanner, or if the rig does not contain its own mounting.
VehicleCalibration read_kitti_calibration(const std::filesystem::path& folder, const StereoRig& rig,
                                          bool with_velodyne);

// Reads the mounting of the scanner alone: calib_imu_to_velo.txt.
VehicleCalibration read_kitti_mounting(const std::filesystem::path& folder);

// Returns the raw grey cameras of calib_cam_to_cam.txt (S, K, D, R, T of 00 and 01) and their
// rectification, without a mounting. Throws as above; `file` names the text.
StereoRig parse_kitti_rig(std::string_view cam_to_cam, const std::filesystem::path& file);

}  // namespace maploop::sensors
