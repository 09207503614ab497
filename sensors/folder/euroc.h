// This file reads drives in EuRoC's format (ASL): Burri et al., "The EuRoC micro aerial vehicle
// datasets", IJRR 2016.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "sensors/camera/stereo_rig.h"
#include "sensors/folder/folder_drive.h"

namespace maploop::sensors {

struct EurocCalibration {
  StereoRig cameras;  // with T_body_left
  // The body's axes are those of B that come nearest to a left camera that looks forward; its
  // origin is the inertial unit.
  Eigen::Matrix3d R_body_B = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_body_imu = Eigen::Matrix3d::Identity();
};

// Returns the folder mav0 that the path is or has; nothing if it is not a drive of this format.
std::optional<std::filesystem::path> find_euroc(const std::filesystem::path& path);

// Reads sensor.yaml of cam0, cam1 and imu0 in the folder mav0: T_BS, resolution, pinhole intrinsics
// and radial-tangential distortion. Without imu0, B is the inertial unit. Throws std::runtime_error
// that names file and key.
EurocCalibration read_euroc_calibration(const std::filesystem::path& folder);

// Reads the drive in the folder mav0: cam0 and cam1 (data.csv, data/*.png), and if they are there
// imu0 (data.csv) and state_groundtruth_estimate0 (data.csv), whose frame stands at latitude and
// longitude 0. `cameras` take the place of the calibration's. Throws std::runtime_error.
DriveParts open_euroc(const std::filesystem::path& folder, Duration max_skew,
                      const std::optional<StereoRig>& cameras);

}  // namespace maploop::sensors
