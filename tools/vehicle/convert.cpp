#include <cmath>
#include <stdexcept>
#include <string>

#include "sensors/folder/euroc.h"
#include "sensors/folder/kitti_360.h"
#include "sensors/replay/kitti_calibration.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

namespace fs = std::filesystem;

// Says which axis of B an axis of the body is, such as "-y".
std::string axis_name(const Eigen::RowVector3d& axis) {
  Eigen::Index i = 0;
  axis.cwiseAbs().maxCoeff(&i);
  return std::string(axis[i] < 0.0 ? "-" : "") + "xyz"[i];
}

}  // namespace

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
  Converted converted{description_of(sensors::read_kitti_360_calibration(folder)),
                      {},
                      "KITTI-360's IMU has x forward, y right, z down: y and z are reversed here."};
  converted.description.lidar.model = "HDL-64E";
  return converted;
}

Converted from_euroc(const fs::path& given) {
  std::error_code ignored;
  const fs::path folder = fs::is_directory(given / "mav0", ignored) ? given / "mav0" : given;
  const sensors::EurocCalibration found = sensors::read_euroc_calibration(folder);
  if (!fs::exists(folder / "imu0/sensor.yaml", ignored))
    throw std::runtime_error("'" + folder.string() + "' has no imu0/sensor.yaml");
  Converted converted;
  VehicleDescription& d = converted.description;
  converted.cameras = found.cameras;
  set_camera_pose(
      *found.cameras.T_body_left * Eigen::Isometry3d(found.cameras.R_rect_left).inverse(),
      d.camera.position, d.camera.rotation);
  d.camera.position.forward_sigma = d.camera.position.left_sigma = d.camera.position.up_sigma =
      0.005;
  d.camera.rotation.roll_sigma = d.camera.rotation.pitch_sigma = d.camera.rotation.yaw_sigma = 0.2;
  SensorPosition origin;
  set_sensor_pose(Eigen::Isometry3d(found.R_body_imu), origin, d.imu.rotation);
  d.imu.rotation.roll_sigma = d.imu.rotation.pitch_sigma = d.imu.rotation.yaw_sigma = 0.5;
  const Eigen::Matrix3d& R = found.R_body_B;
  converted.note = "The body's x, y, z are " + axis_name(R.row(0)) + ", " + axis_name(R.row(1)) +
                   ", " + axis_name(R.row(2)) + " of EuRoC's B.";
  return converted;
}

}  // namespace maploop::vehicle_tool
