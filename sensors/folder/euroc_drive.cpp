#include <stdexcept>
#include <system_error>
#include <utility>

#include "msgs/frames.h"
#include "sensors/folder/euroc.h"
#include "sensors/folder/image_lists.h"
#include "sensors/folder/table_recording.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// The columns are told by their places, because their headings are spelled in several ways.
TableFile table_of(const fs::path& file, std::vector<std::string> columns) {
  TableFile table;
  if (!is_there(file)) return table;
  table.file = file;
  table.columns = std::move(columns);
  table.time = {table.columns.front()};
  table.time_unit = TimeUnit::ns;
  return table;
}

TableMapping tables_of(const fs::path& folder, const EurocCalibration& calibration) {
  TableMapping m;
  static_cast<TableFile&>(m.imu) =
      table_of(folder / "imu0/data.csv", {"timestamp", "wx", "wy", "wz", "ax", "ay", "az"});
  m.imu.gyro = {{"wx", "wy", "wz"}};
  m.imu.accelerometer = {{"ax", "ay", "az"}};
  ReferenceTable& truth = m.reference;
  static_cast<TableFile&>(truth) = table_of(
      folder / "state_groundtruth_estimate0/data.csv",
      {"timestamp", "px", "py", "pz", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "gyro_bias_x",
       "gyro_bias_y", "gyro_bias_z", "force_bias_x", "force_bias_y", "force_bias_z"});
  truth.form = PositionForm::local;
  truth.position = {{"px", "py", "pz"}};
  truth.velocity = {{"vx", "vy", "vz"}};
  truth.velocity_axes = VelocityAxes::enu;
  truth.quaternion = {{"qw", "qx", "qy", "qz"}};
  truth.R_unit_body = calibration.R_body_B.transpose();
  truth.accuracy = 0.01;
  truth.peer = false;
  return m;
}

}  // namespace

std::optional<fs::path> find_euroc(const fs::path& path) {
  for (const fs::path& folder : {path / "mav0", path})
    if (is_there(folder / "cam0/sensor.yaml") || is_there(folder / "imu0/sensor.yaml"))
      return folder;
  return std::nullopt;
}

DriveParts open_euroc(const fs::path& folder, Duration max_skew,
                      const std::optional<StereoRig>& cameras) {
  for (const char* camera : {"cam0", "cam1"}) {
    if (!is_there(folder / camera / "data.csv")) {
      throw std::runtime_error("the drive '" + folder.string() + "' has no " + camera +
                               "/data.csv: the images of a pair of cameras are needed, one camera "
                               "or an inertial unit alone is not supported");
    }
  }
  const EurocCalibration calibration = read_euroc_calibration(folder);
  DriveParts parts;
  parts.folder = folder;
  parts.images = find_images(folder, max_skew);
  parts.raw_cameras = cameras ? cameras : calibration.cameras;
  parts.calibration.stereo =
      mounted(*parts.raw_cameras,
              parts.raw_cameras->T_body_left.value_or(*calibration.cameras.T_body_left));
  const Eigen::Matrix3d& R = calibration.R_body_imu;
  parts.mount = {true, degrees(std::atan2(R(2, 1), R(2, 2))), degrees(-std::asin(R(2, 0))),
                 degrees(std::atan2(R(1, 0), R(0, 0)))};
  const TableMapping tables = tables_of(folder, calibration);
  if (tables.imu.given() || tables.reference.given())
    parts.tables = std::make_shared<const TableRecording>(tables);
  return parts;
}

}  // namespace maploop::sensors
