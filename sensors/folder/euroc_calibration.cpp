// Reads sensor.yaml: "key: value", "key: [numbers]", and T_BS with data: [16
// numbers] over several lines.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "msgs/vehicle_description.h"
#include "sensors/camera/rectification.h"
#include "sensors/folder/euroc.h"
#include "sensors/replay/files.h"
#include "sensors/replay/keyed_text.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

class SensorYaml {
 public:
  explicit SensorYaml(const fs::path& file) : file_(file), text_(read_calibration_text(file)) {
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
      values = parse_numbers(list);
    } catch (const std::invalid_argument& error) {
      fail(key, error.what());
    }
    if (values.size() != count) {
      fail(key,
           "has " + std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
    }
    return values;
  }

  bool is(const std::string& key, std::string_view wanted) const {
    const std::string_view rest = std::string_view(text_).substr(value(key));
    return rest.substr(0, rest.find('\n')).find(wanted) != std::string_view::npos;
  }

  Eigen::Isometry3d pose() const {
    const std::vector<double> all = numbers("T_BS", 16);
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> printed(all.data());
    const Eigen::Matrix3d rotation = printed.topLeftCorner<3, 3>();
    const auto nearest = nearest_rotation(rotation);
    if (!nearest) fail("T_BS", why_no_rotation(rotation));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = *nearest;
    T.translation() = printed.topRightCorner<3, 1>();
    return T;
  }

  CameraModel camera() const {
    if (!is("camera_model", "pinhole"))
      fail("camera_model", "is not pinhole, the only model that is understood");
    const std::vector<double> k = numbers("intrinsics", 4);
    const std::vector<double> d = numbers("distortion_coefficients", 4);
    CameraModel camera{k[0], k[1], k[2], k[3], {}};
    if (is("distortion_model", maploop::to_string(Lens::radial_tangential))) {
      camera.distortion = {.k1 = d[0], .k2 = d[1], .p1 = d[2], .p2 = d[3]};
    } else if (is("distortion_model", maploop::to_string(Lens::equidistant))) {
      camera.distortion = {
          .k1 = d[0], .k2 = d[1], .k3 = d[2], .k4 = d[3], .lens = Lens::equidistant};
    } else {
      fail("distortion_model", "is neither radial-tangential nor equidistant");
    }
    return camera;
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

}  // namespace

EurocCalibration read_euroc_calibration(const fs::path& folder) {
  const SensorYaml left(folder / "cam0/sensor.yaml"), right(folder / "cam1/sensor.yaml");
  std::error_code ignored;
  const fs::path imu_file = folder / "imu0/sensor.yaml";
  const Eigen::Isometry3d T_B_imu =
      fs::exists(imu_file, ignored) ? SensorYaml(imu_file).pose() : Eigen::Isometry3d::Identity();
  const std::vector<double> size = left.numbers("resolution", 2);
  if (right.numbers("resolution", 2) != size) right.fail("resolution", "differs from cam0's");
  for (const double side : size)
    if (!(side >= 16.0 && side <= 16384.0)) left.fail("resolution", "is not 16 to 16384 px");
  const Eigen::Isometry3d T_B_left = left.pose();

  EurocCalibration calibration;
  calibration.R_body_B = body_axes(left, T_B_left.linear());
  calibration.cameras = rectify(left.camera(), right.camera(), right.pose().inverse() * T_B_left,
                                static_cast<int>(size[0]), static_cast<int>(size[1]));
  const Eigen::Isometry3d T_body_B =
      Eigen::Isometry3d(calibration.R_body_B) * Eigen::Translation3d(-T_B_imu.translation());
  calibration.cameras.T_body_left = T_body_B * T_B_left;
  calibration.R_body_imu = T_body_B.linear() * T_B_imu.linear();
  return calibration;
}

}  // namespace maploop::sensors
