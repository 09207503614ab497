// Reads sensor.yaml of EuRoC's format: "key: value", "key: [numbers]", and T_BS with data: [16
// numbers] over several lines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sensors/replay/files.h"
#include "sensors/replay/keyed_text.h"
#include "tools/calibrate/board_adjustment.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

namespace fs = std::filesystem;

class SensorYaml {
 public:
  explicit SensorYaml(const fs::path& file)
      : file_(file), text_(sensors::read_calibration_text(file)) {
    // Comments are blanked.
    for (std::size_t at = text_.find('#'); at != std::string::npos; at = text_.find('#', at)) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      std::fill(text_.begin() + static_cast<std::ptrdiff_t>(at),
                text_.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    }
  }

  // Returns the numbers in brackets of a key.
  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    // Lines that begin with a space belong to the key.
    const std::size_t at = value(key);
    std::size_t end = text_.find('\n', at);
    while (end != std::string::npos && end + 1 < text_.size() && text_[end + 1] == ' ')
      end = text_.find('\n', end + 1);
    std::string list = text_.substr(at, end == std::string::npos ? end : end - at);
    const std::size_t open = list.find('['), close = list.find(']');
    if (open == std::string::npos || close == std::string::npos || close < open)
      fail(key, "has no list of numbers in brackets");
    list = list.substr(open + 1, close - open - 1);
    std::replace_if(
        list.begin(), list.end(), [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ' ');
    std::vector<double> values;
    try {
      values = sensors::parse_numbers(list);
    } catch (const std::invalid_argument& error) {
      fail(key, error.what());
    }
    if (values.size() != count)
      fail(key, fmt::format("has {} numbers instead of {}", values.size(), count));
    return values;
  }

  void must_be(const std::string& key, std::string_view wanted) const {
    const std::string_view rest = std::string_view(text_).substr(value(key));
    const std::string_view line = rest.substr(0, rest.find('\n'));
    if (line.find(wanted) == std::string_view::npos)
      fail(key, "is not " + std::string(wanted) + ", the only model that is understood");
  }

  Eigen::Isometry3d pose() const {
    const std::vector<double> all = numbers("T_BS", 16);
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> printed(all.data());
    const Eigen::Matrix3d rotation = printed.topLeftCorner<3, 3>();
    const auto nearest = sensors::nearest_rotation(rotation);
    if (!nearest) fail("T_BS", sensors::why_no_rotation(rotation));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = *nearest;
    T.translation() = printed.topRightCorner<3, 1>();
    return T;
  }

  sensors::CameraModel camera() const {
    must_be("camera_model", "pinhole");
    must_be("distortion_model", "radial-tangential");
    const std::vector<double> k = numbers("intrinsics", 4);
    const std::vector<double> d = numbers("distortion_coefficients", 4);
    return {k[0], k[1], k[2], k[3], {d[0], d[1], d[2], d[3], 0.0}};
  }

  [[noreturn]] void fail(const std::string& key, const std::string& problem) const {
    throw std::runtime_error("calibration '" + file_.string() + "', key '" + key + "': " + problem);
  }

 private:
  // Returns where the value of a key at the start of a line begins.
  std::size_t value(const std::string& key) const {
    const std::string start = '\n' + key + ':';
    if (text_.starts_with(start.substr(1))) return start.size() - 1;
    const std::size_t at = text_.find(start);
    if (at == std::string::npos) fail(key, "is missing");
    return at + start.size();
  }

  fs::path file_;
  std::string text_;
};

// Returns the axes of a body, of those of B, in which a camera comes nearest to looking forward.
Eigen::Matrix3d body_axes(const SensorYaml& yaml, const Eigen::Matrix3d& R_B_cam) {
  const Eigen::Matrix3d exact = camera_pose({}, {}).linear() * R_B_cam.transpose();
  Eigen::Matrix3d R_body_B = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    Eigen::Index column = 0;
    exact.row(row).cwiseAbs().maxCoeff(&column);
    R_body_B(row, column) = std::copysign(1.0, exact(row, column));
  }
  if (R_body_B.determinant() < 0.5)
    yaml.fail("T_BS", "turns the camera by 45 deg or more from all axes of the body");
  return R_body_B;
}

// Says which axis of B an axis of the body is, such as "-y".
std::string axis_name(const Eigen::RowVector3d& axis) {
  Eigen::Index i = 0;
  axis.cwiseAbs().maxCoeff(&i);
  return std::string(axis[i] < 0.0 ? "-" : "") + "xyz"[i];
}

}  // namespace

Converted from_euroc(const fs::path& given) {
  std::error_code ignored;
  const fs::path folder = fs::is_directory(given / "mav0", ignored) ? given / "mav0" : given;
  const SensorYaml left(folder / "cam0/sensor.yaml"), right(folder / "cam1/sensor.yaml");
  const SensorYaml imu(folder / "imu0/sensor.yaml");
  const std::vector<double> size = left.numbers("resolution", 2);
  if (right.numbers("resolution", 2) != size) right.fail("resolution", "differs from cam0's");
  for (const double side : size)
    if (!(side >= 16.0 && side <= 16384.0)) left.fail("resolution", "is not 16 to 16384 px");
  const Eigen::Isometry3d T_B_left = left.pose();
  const Eigen::Matrix3d R_body_B = body_axes(left, T_B_left.linear());

  Converted converted;
  VehicleDescription& d = converted.description;
  converted.cameras =
      calibrate::rectify({left.camera(), right.camera(), right.pose().inverse() * T_B_left},
                         static_cast<int>(size[0]), static_cast<int>(size[1]));
  // The body's origin is the inertial unit.
  const Eigen::Isometry3d T_body_B =
      Eigen::Isometry3d(R_body_B) * Eigen::Translation3d(-imu.pose().translation());
  set_camera_pose(T_body_B * T_B_left * Eigen::Isometry3d(converted.cameras->R_rect_left).inverse(),
                  d.camera.position, d.camera.rotation);
  d.camera.position.forward_sigma = d.camera.position.left_sigma = d.camera.position.up_sigma =
      0.005;
  d.camera.rotation.roll_sigma = d.camera.rotation.pitch_sigma = d.camera.rotation.yaw_sigma = 0.2;
  SensorPosition origin;
  set_sensor_pose(T_body_B * imu.pose(), origin, d.imu.rotation);
  d.imu.rotation.roll_sigma = d.imu.rotation.pitch_sigma = d.imu.rotation.yaw_sigma = 0.5;
  converted.note =
      fmt::format("The body's x, y, z are {}, {}, {} of EuRoC's B.", axis_name(R_body_B.row(0)),
                  axis_name(R_body_B.row(1)), axis_name(R_body_B.row(2)));
  return converted;
}

}  // namespace maploop::vehicle_tool
