// This file parses texts of "KEY: numbers" lines, the form of KITTI's calibration.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::sensors {

// Holds one file's text, which must outlive it. Every function throws std::runtime_error that names
// file and key.
class KeyedText {
 public:
  KeyedText(std::string_view text, const std::filesystem::path& file);

  // Returns exactly `count` finite numbers.
  std::vector<double> numbers(std::string_view key, std::size_t count) const;

  // Returns the rotation nearest to nine numbers, row by row, which must form a rotation to 1e-3.
  Eigen::Matrix3d rotation(std::string_view key) const;

  // Returns the rigid transformation of keys R and T. Sensors of one car are at most 10 m apart.
  Eigen::Isometry3d transformation() const;

  // Does the same for twelve numbers of one key, row by row: a rotation beside a translation.
  Eigen::Isometry3d rigid(std::string_view key) const;

  // Returns two whole numbers: an image's width and height, px.
  std::vector<double> size(std::string_view key) const;

  [[noreturn]] void fail(std::string_view key, const std::string& reason) const;

 private:
  Eigen::Matrix3d rotation(std::string_view key, const Eigen::Matrix3d& printed) const;
  std::string_view value(std::string_view key) const;

  std::vector<std::string_view> lines_;
  std::string file_;
};

// Reads the text of a calibration file. Throws std::runtime_error that names it.
std::string read_calibration_text(const std::filesystem::path& file);

}  // namespace maploop::sensors
