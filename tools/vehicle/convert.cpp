#include "sensors/replay/files.h"
#include "sensors/replay/keyed_text.h"
#include "sensors/replay/kitti_calibration.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace fs = std::filesystem;

Converted from_kitti(const fs::path& folder) {
  std::error_code ignored;
  const bool is_drive = !fs::exists(folder / "calib_imu_to_velo.txt", ignored) &&
                        fs::is_directory(folder / "image_00", ignored);
  const VehicleCalibration calibration =
      sensors::read_kitti_calibration(is_drive ? fs::canonical(folder).parent_path() : folder);
  Converted converted{description_of(calibration), {}, "KITTI's axes of the IMU are the body's."};
  sensors::describe_kitti_car(calibration, converted.description);
  return converted;
}

Converted from_kitti_360(const fs::path& given) {
  std::error_code ignored;
  const fs::path folder =
      fs::is_directory(given / "calibration", ignored) ? given / "calibration" : given;
  const std::string perspective_text = sensors::read_calibration_text(folder / "perspective.txt");
  const std::string pose_text = sensors::read_calibration_text(folder / "calib_cam_to_pose.txt");
  // This file has numbers without a key.
  const std::string velo_text =
      "cam_to_velo: " + sensors::read_calibration_text(folder / "calib_cam_to_velo.txt");
  const sensors::KeyedText perspective(perspective_text, folder / "perspective.txt");
  const sensors::KeyedText pose(pose_text, folder / "calib_cam_to_pose.txt");
  const sensors::KeyedText velo(velo_text, folder / "calib_cam_to_velo.txt");

  Eigen::Isometry3d T_body_imu = Eigen::Isometry3d::Identity();
  T_body_imu.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  const Eigen::Isometry3d T_body_raw = T_body_imu * pose.rigid("image_00");
  VehicleCalibration calibration;
  calibration.stereo = sensors::parse_rectified_pair(perspective);
  calibration.stereo.T_body_cam =
      T_body_raw * Eigen::Isometry3d(perspective.rotation("R_rect_00")).inverse();
  calibration.T_body_velo = T_body_raw * velo.rigid("cam_to_velo").inverse();
  Converted converted{description_of(calibration),
                      {},
                      "KITTI-360's IMU has x forward, y right, z down: y and z are reversed here."};
  converted.description.lidar.model = "HDL-64E";
  return converted;
}

}  // namespace maploop::vehicle_tool
