#include "tools/simulate/town/lane_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr double junction_radius = 11.0;  // m; within it a car leaves its lane's line
constexpr int line_smoothing = 10;  // passes of (1 2 1) / 4 over points 1 m apart: sigma of 2.2 m

// Returns the lane of a street, without its junctions.
Line lane_of(const Streets& streets, DirectedStreet d) {
  const Line line = streets.centreline(d);
  const double offset = streets.streets[d.street].lane();
  Line lane;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if ((line[i] - line.front()).norm() < junction_radius ||
        (line[i] - line.back()).norm() < junction_radius)
      continue;
    const Eigen::Vector2d t = direction_at(line, i);
    lane.push_back(line[i] + offset * Eigen::Vector2d(t.y(), -t.x()));
  }
  if (lane.size() >= 2) return lane;
  // A street that is hardly longer than its junctions is represented by its middle.
  const std::size_t m = line.size() / 2;
  const Eigen::Vector2d t = direction_at(line, m), right(t.y(), -t.x());
  const Eigen::Vector2d middle = 0.5 * (line.front() + line.back()) + offset * right;
  return {middle - 0.5 * t, middle + 0.5 * t};
}

void append_curve(Line& line, const Line& next) {
  const Eigen::Vector2d a = line.back(), b = next.front();
  const double reach = 0.5 * (b - a).norm();
  const Eigen::Vector2d c = a + reach * direction_at(line, line.size() - 1);
  const Eigen::Vector2d d = b - reach * direction_at(next, 0);
  for (int i = 1; i < 32; ++i) {
    const double t = i / 32.0, s = 1.0 - t;
    line.push_back(s * s * s * a + 3.0 * s * s * t * c + 3.0 * s * t * t * d + t * t * t * b);
  }
}

// Returns points 1 m apart. `marks` are indices of points and become their distances along the
// line.
Line resampled(const Line& line, std::vector<double>& marks) {
  const std::vector<double> along = distances_along(line);
  for (double& mark : marks) mark = along[static_cast<std::size_t>(mark)];
  Line result;
  std::size_t i = 1;
  for (double s = 0.0; s < along.back(); s += 1.0) {
    while (along[i] < s) ++i;
    const double t = (s - along[i - 1]) / std::max(1e-9, along[i] - along[i - 1]);
    result.push_back(line[i - 1] + t * (line[i] - line[i - 1]));
  }
  return result;
}

// Returns the offset to the left in m for each point: small waves, and occasional shifts of 1 m
// that last 56 m.
std::vector<double> wander(std::size_t count, std::uint64_t seed) {
  Random random(seed, 4);
  std::vector<double> offset(count, 0.0);
  for (int w = 0; w < 3; ++w) {
    const double length = random.uniform(40.0, 120.0), phase = random.uniform(0.0, 6.28);
    for (std::size_t i = 0; i < count; ++i)
      offset[i] +=
          0.07 * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / length + phase);
  }
  const auto step = [](double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
  };
  for (double begin = random.uniform(60.0, 160.0); begin < static_cast<double>(count);
       begin += random.uniform(180.0, 320.0))
    for (std::size_t i = 0; i < count; ++i) {
      const double s = static_cast<double>(i) - begin;
      offset[i] += 1.0 * (step(s / 22.0) - step((s - 34.0) / 22.0));
    }
  return offset;
}

}  // namespace

LanePath::LanePath(const Streets& streets, const std::vector<DirectedStreet>& route,
                   std::uint64_t seed) {
  Line line;
  std::vector<double> marks;  // indices of start and end of each lane
  for (const DirectedStreet& d : route) {
    const Line lane = lane_of(streets, d);
    if (!line.empty()) append_curve(line, lane);
    marks.push_back(static_cast<double>(line.size()));
    line.insert(line.end(), lane.begin(), lane.end());
    marks.push_back(static_cast<double>(line.size() - 1));
  }
  points_ = resampled(line, marks);
  const std::vector<double> left = wander(points_.size(), seed);
  const Line lane = points_;
  for (std::size_t i = 0; i < lane.size(); ++i) {
    const Eigen::Vector2d t = direction_at(lane, i);
    points_[i] += left[i] * Eigen::Vector2d(-t.y(), t.x());
  }
  smooth(points_, line_smoothing);
  // The first street begins, and the last one ends, one junction radius outside the path.
  for (std::size_t i = 0; i < route.size(); ++i) {
    const double before = i > 0 ? 0.5 * (marks[2 * i - 1] + marks[2 * i]) : -junction_radius;
    const double after = i + 1 < route.size() ? 0.5 * (marks[2 * i + 1] + marks[2 * i + 2])
                                              : length() + junction_radius;
    stretches_.push_back({route[i], before, after, marks[2 * i + 1]});
  }
}

Eigen::Vector2d LanePath::evaluate(double way, int order) const {
  const double u = std::clamp(way, 0.0, length() - 1e-9);
  const auto i = static_cast<std::size_t>(u);
  const double t = u - static_cast<double>(i), s = 1.0 - t;
  const Eigen::Vector2d &a = points_[i], &b = points_[i + 1], &c = points_[i + 2],
                        &d = points_[i + 3];
  if (order == 0)
    return (s * s * s * a + (3.0 * t * t * t - 6.0 * t * t + 4.0) * b +
            (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) * c + t * t * t * d) /
           6.0;
  if (order == 1)
    return (-s * s * a + (3.0 * t * t - 4.0 * t) * b + (-3.0 * t * t + 2.0 * t + 1.0) * c +
            t * t * d) /
           2.0;
  return s * a + (3.0 * t - 2.0) * b + (1.0 - 3.0 * t) * c + t * d;
}

double LanePath::curvature(double way) const {
  const Eigen::Vector2d d = evaluate(way, 1), dd = evaluate(way, 2);
  return (d.x() * dd.y() - d.y() * dd.x()) / std::pow(d.squaredNorm(), 1.5);
}

}  // namespace maploop::simulate
