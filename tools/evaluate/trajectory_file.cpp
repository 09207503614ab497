#include "tools/evaluate/trajectory_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "ppp/models/geodesy.h"
#include "runtime/core/number_text.h"
#include "sensors/folder/number_table.h"
#include "sensors/replay/files.h"
#include "sensors/replay/pose_odometry.h"
#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/rtklib_positions.h"
#include "tools/evaluate/text_file.h"

namespace maploop::evaluation {
namespace {

double finite_number(const TextLines& lines, std::string_view word) {
  const auto value = number_of<double>(word);
  if (!value || !std::isfinite(*value))
    lines.fail(sensors::quoted(word) + " is not a finite number");
  return *value;
}

// Whole and fractional part are parsed separately, because a double cannot represent a present-day
// stamp in nanoseconds.
Time stamp_of(const TextLines& lines, std::string_view word) {
  constexpr double largest = 9e9;  // s, in range of 64-bit nanoseconds
  const double seconds = finite_number(lines, word);
  if (std::abs(seconds) > largest) lines.fail(sensors::quoted(word) + " is not a stamp in seconds");
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || word.find_first_of("eE") != std::string_view::npos)
    return Time(from_seconds(seconds));
  const double whole = point == 0 || word.substr(0, point) == "-"
                           ? 0.0
                           : finite_number(lines, word.substr(0, point));
  const double part = finite_number(lines, "0" + std::string(word.substr(point)));
  return Time(from_seconds(whole) + (word.front() == '-' ? -1 : 1) * from_seconds(part));
}

Eigen::Isometry3d kitti_pose(const TextLines& lines) {
  try {
    const std::vector<double> numbers = sensors::parse_numbers(lines.line());
    if (numbers.size() == 12) return sensors::camera_pose(numbers.data());
    lines.fail("a pose has 12 numbers (3x4, row by row), this line has " +
               std::to_string(numbers.size()));
  } catch (const std::invalid_argument& e) {
    lines.fail(e.what());
  }
}

StampedTrajectory positions_of(const std::vector<RtklibPosition>& positions) {
  StampedTrajectory trajectory;
  trajectory.has_attitude = false;
  trajectory.origin = ppp::geodetic_from_ecef(positions.front().place);
  const LocalFrame frame(*trajectory.origin);
  for (const RtklibPosition& p : positions) {
    trajectory.stamps.push_back(ppp::to_utc(p.time));
    trajectory.poses.emplace_back(
        Eigen::Translation3d(frame.to_enu(ppp::geodetic_from_ecef(p.place))));
  }
  return trajectory;
}

// Returns the columns of recorded truth in the order of TUM's.
std::vector<std::size_t> columns_of(const TextLines& lines, const Cells& heading) {
  std::vector<std::size_t> columns;
  for (const char* name :
       {"t", "cam_x", "cam_y", "cam_z", "cam_qx", "cam_qy", "cam_qz", "cam_qw"}) {
    const auto found = std::find(heading.begin(), heading.end(), name);
    if (found == heading.end())
      lines.fail("the heading names no column '" + std::string(name) + "'");
    columns.push_back(static_cast<std::size_t>(found - heading.begin()));
  }
  return columns;
}

}  // namespace

TumPose tum_pose(const TextLines& lines, const Cells& words) {
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = finite_number(lines, words[i + 1]);
  return {stamp_of(lines, words[0]), {v[0], v[1], v[2]}, {v[6], v[3], v[4], v[5]}};
}

StampedTrajectory read_trajectory(const std::filesystem::path& file, Role role) {
  if (is_lcm_log(file)) return read_log_trajectory(file, role);
  if (sensors::is_pos_file(file)) return positions_of(read_rtklib_positions(file));
  const std::string text = read_text(file);
  TextLines lines(text, file.string());
  StampedTrajectory trajectory;
  std::vector<std::size_t> columns{0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t count = columns.size(); lines.next();) {
    const Cells words = lines.words();
    if (trajectory.poses.empty()) {
      if (words.size() == 12) return {{}, read_kitti_poses(file)};
      if (lines.line().find("cam_x") != std::string_view::npos) {
        columns = columns_of(lines, words);
        count = words.size();
        continue;
      }
    }
    if (words.size() != count) {
      lines.fail("this line has " + std::to_string(words.size()) + " fields, not " +
                 std::to_string(count) +
                 "; a trajectory is KITTI (12 numbers a line), TUM (8), recorded truth (CSV with "
                 "t and cam_x ... cam_qz), RTKLIB's .pos or a log");
    }
    Cells in_order;
    for (const std::size_t column : columns) in_order.push_back(words[column]);
    const TumPose pose = tum_pose(lines, in_order);
    if (!trajectory.stamps.empty() && pose.stamp <= trajectory.stamps.back())
      lines.fail("its stamp is not after the line's before");
    if (!(std::abs(pose.rotation.norm() - 1.0) < 1e-3))
      lines.fail("the quaternion is not of length one");
    trajectory.poses.emplace_back(Eigen::Translation3d(pose.place) * pose.rotation.normalized());
    trajectory.stamps.push_back(pose.stamp);
  }
  if (trajectory.poses.empty()) throw std::runtime_error(file.string() + " holds no pose");
  return trajectory;
}

Trajectory read_kitti_poses(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  TextLines lines(text, file.string());
  Trajectory trajectory;
  while (lines.next()) trajectory.push_back(kitti_pose(lines));
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
      for (int column = 0; column < 4; ++column)
        text += runtime::shortest_text(pose(row, column)) + (row == 2 && column == 3 ? '\n' : ' ');
    }
  }
  write_text(file, text);
}

void write_tum(const std::filesystem::path& file, const StampedTrajectory& trajectory) {
  std::string text;
  for (std::size_t i = 0; i < trajectory.poses.size(); ++i) {
    const Eigen::Vector3d t = trajectory.poses[i].translation();
    const Eigen::Quaterniond q(trajectory.poses[i].linear());
    const std::int64_t ns = to_nanoseconds(trajectory.stamps[i]);
    text +=
        fmt::format("{}{}.{:09} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n",
                    ns < 0 ? "-" : "", std::abs(ns) / 1'000'000'000, std::abs(ns) % 1'000'000'000,
                    t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_text(file, text);
}

Matched match(const StampedTrajectory& estimate, const StampedTrajectory& truth,
              Duration tolerance) {
  Matched matched;
  if (estimate.stamps.empty() || truth.stamps.empty()) {
    matched = {{}, estimate.poses, truth.poses};
    const std::size_t frames = std::min(estimate.poses.size(), truth.poses.size());
    matched.estimate.resize(frames);
    matched.truth.resize(frames);
    matched.frames.resize(frames);
    std::iota(matched.frames.begin(), matched.frames.end(), std::size_t{0});
  }
  std::size_t j = 0;
  for (std::size_t i = 0; i < estimate.stamps.size() && j < truth.stamps.size(); ++i) {
    const auto apart = [&](std::size_t k) {
      return std::chrono::abs(truth.stamps[k] - estimate.stamps[i]);
    };
    while (j + 1 < truth.stamps.size() && apart(j + 1) <= apart(j)) ++j;
    if (apart(j) > tolerance) continue;
    matched.stamps.push_back(estimate.stamps[i]);
    matched.estimate.push_back(estimate.poses[i]);
    matched.truth.push_back(truth.poses[j]);
    matched.frames.push_back(j++);
  }
  matched.unmatched_estimate = estimate.poses.size() - matched.estimate.size();
  matched.unmatched_truth = truth.poses.size() - matched.truth.size();
  return matched;
}

std::string stamp_text(const Matched& matched, std::size_t pose) {
  if (matched.stamps.empty()) return {};
  return fmt::format("{:.6f}", static_cast<double>(to_nanoseconds(matched.stamps[pose])) * 1e-9);
}

Trajectory from_kitti_mercator(const Trajectory& poses, double latitude, double azimuth) {
  constexpr double e2 = 0.00669437999014;
  const double w2 = 1.0 - e2 * std::pow(std::sin(latitude), 2);
  const double east_scale = 1.0 / std::sqrt(w2);              // prime vertical by KITTI's sphere
  const double north_scale = (1.0 - e2) / std::pow(w2, 1.5);  // meridian by KITTI's sphere

  // Rows are east, north, up in terms of a level camera's x (right), y (down), z (ahead).
  Eigen::Matrix3d R_enu_cam;
  R_enu_cam << std::cos(azimuth), 0.0, std::sin(azimuth),  //
      -std::sin(azimuth), 0.0, std::cos(azimuth),          //
      0.0, -1.0, 0.0;
  const Eigen::Matrix3d stretch = R_enu_cam.transpose() *
                                  Eigen::Vector3d(east_scale, north_scale, 1.0).asDiagonal() *
                                  R_enu_cam;
  Trajectory metric;
  for (const Eigen::Isometry3d& pose : poses) {
    metric.push_back(poses.front().inverse() * pose);
    metric.back().translation() = stretch * metric.back().translation();
  }
  return metric;
}

}  // namespace maploop::evaluation
