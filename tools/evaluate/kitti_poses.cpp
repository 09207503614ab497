#include "tools/evaluate/kitti_poses.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sensors/replay/files.h"
#include "tools/evaluate/text_file.h"

namespace maploop::evaluation {
namespace {

constexpr double kRotationTolerance = 1e-3;

using Row = std::array<double, 12>;

// Parses the twelve numbers of a line; returns the error, or nothing.
std::optional<std::string> parse_row(std::string_view line, Row& row) {
  constexpr std::string_view kBlanks = " \t\r";
  std::size_t count = 0;
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    if (count < row.size()) {
      const char* end = word.data() + word.size();
      const auto [stop, error] = std::from_chars(word.data(), end, row[count]);
      if (error != std::errc() || stop != end || !std::isfinite(row[count])) {
        return sensors::quoted(word) + " is not a finite number";
      }
    }
    ++count;
  }
  if (count != row.size()) {
    return "a pose has 12 numbers (3x4, row by row), this line has " + std::to_string(count);
  }
  return std::nullopt;
}

Eigen::Isometry3d to_pose(const Row& row) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(row.data());
  return pose;
}

bool is_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d off = matrix.transpose() * matrix - Eigen::Matrix3d::Identity();
  return off.cwiseAbs().maxCoeff() < kRotationTolerance && matrix.determinant() > 0.0;
}

}  // namespace

Trajectory read_kitti_poses(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  Trajectory trajectory;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + what);
    };
    Row row{};
    if (const auto wrong = parse_row(line, row)) fail(*wrong);
    trajectory.push_back(to_pose(row));
    if (!is_rotation(trajectory.back().linear()))
      fail("the left 3x3 block is not a rotation matrix");
  }
  if (trajectory.empty()) throw std::runtime_error(file.string() + " holds no pose");
  return trajectory;
}

void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::string text;
  for (const Eigen::Isometry3d& pose : trajectory) {
    if (!pose.affine().allFinite()) {
      throw std::invalid_argument("pose " + std::to_string(&pose - trajectory.data()) +
                                  " is not finite; " + file.string() + " was not written");
    }
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        std::array<char, 32> number{};  // at most 24: shortest text that reads back equal
        const auto end = std::to_chars(number.begin(), number.end(), pose(row, column)).ptr;
        text.append(number.begin(), end);
        text += row == 2 && column == 3 ? '\n' : ' ';
      }
    }
  }
  write_text(file, text);
}

}  // namespace maploop::evaluation
