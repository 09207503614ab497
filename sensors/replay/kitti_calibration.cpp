#include "sensors/replay/kitti_calibration.h"

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

// One file of "KEY: values" lines.
class KeyedText {
 public:
  KeyedText(std::string_view text, const std::filesystem::path& file)
      : lines_(split_lines(text)), file_(file.string()) {}

  std::vector<double> numbers(std::string_view key, std::size_t count) const {
    std::vector<double> values;
    try {
      values = parse_numbers(value(key));
    } catch (const std::invalid_argument& error) {
      fail(key, error.what());
    }
    if (values.size() != count) {
      fail(key,
           "has " + std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
    }
    return values;
  }

  Eigen::Matrix3d rotation(std::string_view key) const {
    const std::vector<double> values = numbers(key, 9);
    const Eigen::Matrix3d printed =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
    const double error = (printed * printed.transpose() - Eigen::Matrix3d::Identity()).norm();
    if (!(error < 1e-3) || printed.determinant() < 0.0) fail(key, "is not a rotation matrix");
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(printed, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
  }

  // The rigid transformation of keys R and T. Sensors of one car are not further apart than 10 m.
  Eigen::Isometry3d transformation() const {
    const std::vector<double> values = numbers("T", 3);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation("R");
    T.translation() = Eigen::Map<const Eigen::Vector3d>(values.data());
    if (!(T.translation().norm() < 10.0)) fail("T", "is longer than 10 m");
    return T;
  }

  [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
    throw std::runtime_error("calibration '" + file_ + "', key '" + std::string(key) + "': " +
                             reason + "; restore the file from KITTI's calibration archive");
  }

 private:
  std::string_view value(std::string_view key) const {
    std::optional<std::string_view> found;
    for (const std::string_view line : lines_) {
      if (line.size() <= key.size() || !line.starts_with(key) || line[key.size()] != ':') continue;
      if (found) fail(key, "is given twice");
      found = line.substr(key.size() + 1);
    }
    if (!found) fail(key, "is missing");
    return *found;
  }

  std::vector<std::string_view> lines_;
  std::string file_;
};

StereoCalibration stereo(const KeyedText& text) {
  const std::vector<double> size = text.numbers("S_rect_00", 2);
  const std::vector<double> left = text.numbers("P_rect_00", 12);
  const std::vector<double> right = text.numbers("P_rect_01", 12);
  for (const double side : size) {
    if (side < 1.0 || side > 16384.0 || side != std::round(side)) {
      text.fail("S_rect_00", "is not an image size in pixels");
    }
  }
  if (text.numbers("S_rect_01", 2) != size) text.fail("S_rect_01", "differs from S_rect_00");
  if (left[3] != 0.0) text.fail("P_rect_00", "has an offset: it is not that of the left camera");
  for (const std::size_t i : {0U, 2U, 5U, 6U}) {  // fx, cx, fy, cy
    if (left[i] != right[i]) text.fail("P_rect_01", "has other intrinsics than P_rect_00");
  }
  if (left[0] < 1.0 || left[5] < 1.0 || left[0] > 1e5 || left[5] > 1e5) {
    text.fail("P_rect_00", "has a focal length outside 1 to 100000 pixels");
  }
  StereoCalibration calibration;
  calibration.width = static_cast<int>(size[0]);
  calibration.height = static_cast<int>(size[1]);
  calibration.fx = left[0];
  calibration.fy = left[5];
  calibration.cx = left[2];
  calibration.cy = left[6];
  calibration.baseline = -right[3] / right[0];
  if (!(calibration.baseline > 0.01 && calibration.baseline < 10.0)) {
    text.fail("P_rect_01", "gives a baseline of " + std::to_string(calibration.baseline) +
                               " m, outside 0.01 to 10 m");
  }
  return calibration;
}

std::string read_calibration_text(const std::filesystem::path& file) {
  try {
    return read_text(file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("calibration '" + file.string() + "': " + error.what() +
                             "; put the drive's calibration (a separate archive of KITTI raw) "
                             "beside its folder");
  }
}

}  // namespace

VehicleCalibration parse_kitti_calibration(const KittiCalibrationText& text) {
  const KeyedText cameras(text.cam_to_cam, text.cam_to_cam_file);
  const Eigen::Isometry3d T_cam0_velo =
      KeyedText(text.velo_to_cam, text.velo_to_cam_file).transformation();
  const Eigen::Isometry3d T_velo_body =
      KeyedText(text.imu_to_velo, text.imu_to_velo_file).transformation();

  VehicleCalibration calibration;
  calibration.stereo = stereo(cameras);
  const Eigen::Isometry3d T_cam_cam0(cameras.rotation("R_rect_00"));
  calibration.stereo.T_body_cam = (T_cam_cam0 * T_cam0_velo * T_velo_body).inverse();
  calibration.T_body_velo = T_velo_body.inverse();
  return calibration;
}

VehicleCalibration read_kitti_calibration(const std::filesystem::path& folder) {
  KittiCalibrationText text;
  text.cam_to_cam_file = folder / "calib_cam_to_cam.txt";
  text.velo_to_cam_file = folder / "calib_velo_to_cam.txt";
  text.imu_to_velo_file = folder / "calib_imu_to_velo.txt";
  const std::string cam_to_cam = read_calibration_text(text.cam_to_cam_file);
  const std::string velo_to_cam = read_calibration_text(text.velo_to_cam_file);
  const std::string imu_to_velo = read_calibration_text(text.imu_to_velo_file);
  text.cam_to_cam = cam_to_cam;
  text.velo_to_cam = velo_to_cam;
  text.imu_to_velo = imu_to_velo;
  return parse_kitti_calibration(text);
}

}  // namespace maploop::sensors
