// Texts of "KEY: numbers" lines, as KITTI's calibration is written.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::sensors {

// One file. Every function throws std::runtime_error naming file and key. The text must outlive it.
class KeyedText {
 public:
  KeyedText(std::string_view text, const std::filesystem::path& file);

  // Exactly `count` finite numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count) const;

  // Nine numbers, row by row, a rotation to 1e-3; the nearest true one.
  Eigen::Matrix3d rotation(std::string_view key) const;

  // The rigid transformation of keys R and T. Sensors of one car are not further apart than 10 m.
  Eigen::Isometry3d transformation() const;

  // Two whole numbers: an image size.
  std::vector<double> size(std::string_view key) const;

  [[noreturn]] void fail(std::string_view key, const std::string& reason) const;

 private:
  std::string_view value(std::string_view key) const;

  std::vector<std::string_view> lines_;
  std::string file_;
};

// The text of a calibration file. Throws std::runtime_error naming it.
std::string read_calibration_text(const std::filesystem::path& file);

}  // namespace maploop::sensors
