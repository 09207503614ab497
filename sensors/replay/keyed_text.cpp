#include "sensors/replay/keyed_text.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "sensors/camera/stereo_rig.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {

KeyedText::KeyedText(std::string_view text, const std::filesystem::path& file)
    : lines_(split_lines(text)), file_(file.string()) {}

std::vector<double> KeyedText::numbers(std::string_view key, std::size_t count) const {
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

Eigen::Matrix3d KeyedText::rotation(std::string_view key) const {
  const std::vector<double> values = numbers(key, 9);
  return rotation(key,
                  Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data()));
}

Eigen::Matrix3d KeyedText::rotation(std::string_view key, const Eigen::Matrix3d& printed) const {
  const auto nearest = nearest_rotation(printed);
  if (!nearest) fail(key, why_no_rotation(printed));
  return *nearest;
}

Eigen::Isometry3d KeyedText::rigid(std::string_view key) const {
  const std::vector<double> values = numbers(key, 12);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> printed(values.data());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation(key, printed.leftCols<3>());
  T.translation() = printed.rightCols<1>();
  if (!(T.translation().norm() < 10.0)) fail(key, "is longer than 10 m");
  return T;
}

Eigen::Isometry3d KeyedText::transformation() const {
  const std::vector<double> values = numbers("T", 3);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation("R");
  T.translation() = Eigen::Map<const Eigen::Vector3d>(values.data());
  if (!(T.translation().norm() < 10.0)) fail("T", "is longer than 10 m");
  return T;
}

void KeyedText::fail(std::string_view key, const std::string& reason) const {
  throw std::runtime_error("calibration '" + file_ + "', key '" + std::string(key) +
                           "': " + reason + "; restore the file from KITTI's calibration archive");
}

std::string_view KeyedText::value(std::string_view key) const {
  std::optional<std::string_view> found;
  for (const std::string_view line : lines_) {
    if (line.size() <= key.size() || !line.starts_with(key) || line[key.size()] != ':') continue;
    if (found) fail(key, "is given twice");
    found = line.substr(key.size() + 1);
  }
  if (!found) fail(key, "is missing");
  return *found;
}

std::vector<double> KeyedText::size(std::string_view key) const {
  std::vector<double> sides = numbers(key, 2);
  for (const double side : sides) {
    if (side < 1.0 || side > 16384.0 || side != std::round(side)) {
      fail(key, "is not an image size in pixels");
    }
  }
  if (sides[0] * sides[1] > static_cast<double>(input_limits::pixels)) {
    fail(key, "is an image of more than " + std::to_string(input_limits::pixels) + " pixels");
  }
  return sides;
}

std::string read_calibration_text(const std::filesystem::path& file) {
  try {
    return read_text(file);
  } catch (const FileError& error) {
    throw std::runtime_error("calibration '" + file.string() + "': " + error.reason() +
                             "; put the drive's calibration (a separate archive of KITTI raw) "
                             "beside its folder");
  }
}

}  // namespace maploop::sensors
