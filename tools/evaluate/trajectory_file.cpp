#include "tools/evaluate/trajectory_file.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sensors/replay/files.h"
#include "tools/evaluate/text_file.h"

namespace maploop::evaluation {
namespace {

using Pose = std::array<double, 7>;  // x y z qw qx qy qz

class LineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::vector<std::string_view> words(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r,";
  std::vector<std::string_view> all;
  for (std::size_t end = 0;;) {
    const std::size_t begin = line.find_first_not_of(kBetween, end);
    if (begin == std::string_view::npos) return all;
    end = std::min(line.find_first_of(kBetween, begin), line.size());
    all.push_back(line.substr(begin, end - begin));
  }
}

double to_number(std::string_view word) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value))
    throw LineError(sensors::quoted(word) + " is not a finite number");
  return value;
}

// Whole and fractional part are parsed separately, because a double cannot represent a present-day
// stamp in nanoseconds.
Time to_time(std::string_view word) {
  constexpr double kLargest = 9e9;  // s, in range of 64-bit nanoseconds
  if (std::abs(to_number(word)) > kLargest)
    throw LineError(sensors::quoted(word) + " is no stamp in seconds");
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || word.find_first_of("eE") != std::string_view::npos)
    return Time(from_seconds(to_number(word)));
  const double whole =
      point == 0 || word.substr(0, point) == "-" ? 0.0 : to_number(word.substr(0, point));
  const double part = to_number("0" + std::string(word.substr(point)));
  return Time(from_seconds(whole) + (word.front() == '-' ? -1 : 1) * from_seconds(part));
}

Eigen::Isometry3d to_pose(const Pose& p) {
  const Eigen::Quaterniond q(p[3], p[4], p[5], p[6]);
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) throw LineError("the quaternion is not of length one");
  return Eigen::Translation3d(p[0], p[1], p[2]) * q.normalized();
}

// The indices of the stamp and of the pose's seven numbers in a line.
struct Columns {
  std::size_t count = 8;
  std::size_t stamp = 0;
  std::array<std::size_t, 7> pose = {1, 2, 3, 7, 4, 5, 6};  // TUM
};

Columns columns_of(const std::vector<std::string_view>& heading) {
  const auto find = [&](std::string_view name) {
    const auto found = std::find(heading.begin(), heading.end(), name);
    if (found == heading.end())
      throw LineError("the heading names no column '" + std::string(name) + "'");
    return static_cast<std::size_t>(found - heading.begin());
  };
  return {heading.size(),
          find("t"),
          {find("cam_x"), find("cam_y"), find("cam_z"), find("cam_qw"), find("cam_qx"),
           find("cam_qy"), find("cam_qz")}};
}

StampedTrajectory read_stamped(std::istream& in, const std::filesystem::path& file) {
  StampedTrajectory trajectory;
  Columns columns;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto fields = words(line);
    if (fields.empty() || fields.front().front() == '#') continue;
    try {
      if (number == 1 && line.find("cam_x") != std::string::npos) {
        columns = columns_of(fields);
        continue;
      }
      if (fields.size() != columns.count)
        throw LineError("this line has " + std::to_string(fields.size()) + " fields, not " +
                        std::to_string(columns.count) +
                        "; a trajectory is KITTI (12 numbers a line), TUM (8) or recorded truth "
                        "(CSV with t and cam_x ... cam_qz)");
      Pose pose{};
      for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = to_number(fields[columns.pose[i]]);
      const Time stamp = to_time(fields[columns.stamp]);
      if (!trajectory.stamps.empty() && stamp <= trajectory.stamps.back())
        throw LineError("its stamp is not after the line's before");
      trajectory.poses.push_back(to_pose(pose));
      trajectory.stamps.push_back(stamp);
    } catch (const LineError& e) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  if (trajectory.poses.empty()) throw std::runtime_error(file.string() + " holds no pose");
  return trajectory;
}

}  // namespace

StampedTrajectory read_trajectory(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  for (std::string line; std::getline(in, line);) {
    const auto fields = words(line);
    if (fields.empty() || fields.front().front() == '#') continue;
    if (fields.size() == 12) return {{}, read_kitti_poses(file)};
    break;
  }
  in.clear();
  in.seekg(0);
  return read_stamped(in, file);
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
  if (estimate.stamps.empty() || truth.stamps.empty()) {
    const auto frames =
        static_cast<std::ptrdiff_t>(std::min(estimate.poses.size(), truth.poses.size()));
    return {{},
            {estimate.poses.begin(), estimate.poses.begin() + frames},
            {truth.poses.begin(), truth.poses.begin() + frames},
            estimate.poses.size() - static_cast<std::size_t>(frames),
            truth.poses.size() - static_cast<std::size_t>(frames)};
  }
  Matched matched;
  std::size_t j = 0;
  for (std::size_t i = 0; i < estimate.stamps.size() && j < truth.stamps.size(); ++i) {
    const auto apart = [&](std::size_t k) {
      return std::chrono::abs(truth.stamps[k] - estimate.stamps[i]);
    };
    while (j + 1 < truth.stamps.size() && apart(j + 1) <= apart(j)) ++j;
    if (apart(j) > tolerance) continue;
    matched.stamps.push_back(estimate.stamps[i]);
    matched.estimate.push_back(estimate.poses[i]);
    matched.truth.push_back(truth.poses[j++]);
  }
  matched.unmatched_estimate = estimate.poses.size() - matched.estimate.size();
  matched.unmatched_truth = truth.poses.size() - matched.truth.size();
  return matched;
}

}  // namespace maploop::evaluation
