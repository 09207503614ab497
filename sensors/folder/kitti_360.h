// This file reads drives of KITTI-360: Liao, Xie, Geiger, "KITTI-360", PAMI 2022.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "msgs/calibration.h"
#include "sensors/folder/folder_drive.h"

namespace maploop::sensors {

// Names a drive: the folder of the data set, and the drive's name in data_2d_raw, data_3d_raw and
// data_poses.
struct Kitti360Name {
  std::filesystem::path root;
  std::string drive;
};

// `path` is the data set's folder, if it has one drive, or that of a drive in one of the three.
// Returns nothing if it is neither. Throws std::runtime_error that names the drives if there are
// several, or none.
std::optional<Kitti360Name> find_kitti_360(const std::filesystem::path& path);

// Reads perspective.txt, calib_cam_to_pose.txt and calib_cam_to_velo.txt. KITTI-360's IMU has x
// forward, y right, z down, of which the body reverses y and z. Throws std::runtime_error that
// names file and key.
VehicleCalibration read_kitti_360_calibration(const std::filesystem::path& folder);

// Reads, where they are there: image_00 and image_01 (data_rect/%010d.png, timestamps.txt) in
// data_2d_raw; velodyne_points (data/%010d.bin, timestamps.txt) in data_3d_raw, whose scans are
// taken to begin and end half a turn before and after their stamps; and oxts (data/%010d.txt,
// timestamps.txt) in data_poses. Throws std::runtime_error.
DriveParts open_kitti_360(const Kitti360Name& name);

}  // namespace maploop::sensors
