#include "tools/simulate/sensors/speed_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr double control_interval = 0.1;  // s between control points
constexpr double first_way = 15;          // m, where the drive starts on the path
constexpr int speed_smoothing = 12;       // passes of (1 2 1) / 4: sigma of 0.25 s, within 1.2 s

// Returns m/s at each metre of the way, from speed limits and curves alone.
std::vector<double> allowed(const LanePath& path, const Streets& streets,
                            const DriverParameters& p) {
  std::vector<double> speed(static_cast<std::size_t>(path.length()));
  auto stretch = path.stretches().begin();
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const auto way = static_cast<double>(i);
    while (way > stretch->end && stretch + 1 != path.stretches().end()) ++stretch;
    const double curve =
        std::sqrt(p.lateral_acceleration / std::max(1e-4, std::fabs(path.curvature(way))));
    speed[i] = std::min(streets.streets[stretch->street.street].speed_limit, curve);
  }
  return speed;
}

// Lowers the speeds to those that can be reached by acceleration and braking.
void respect_accelerations(std::vector<double>& speed, const DriverParameters& p) {
  for (std::size_t i = speed.size() - 1; i-- > 0;)
    speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + 2.0 * p.braking));
  for (std::size_t i = 1; i < speed.size(); ++i)
    speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2.0 * p.acceleration));
}

double value_at(const std::vector<double>& values, double way) {
  const auto i = std::min(static_cast<std::size_t>(way), values.size() - 2);
  const double t = std::clamp(way - static_cast<double>(i), 0.0, 1.0);
  return (1.0 - t) * values[i] + t * values[i + 1];
}

}  // namespace

double longest_drive(double seconds, double fastest) {
  return fastest * (seconds + 4.0) + 100.0;
}

SpeedProfile::SpeedProfile(const LanePath& path, const Streets& streets, double seconds,
                           std::uint64_t seed, const DriverParameters& parameters) {
  const auto require = [&](double length) {
    if (path.length() < length) throw std::runtime_error("the route is too short for the drive");
  };
  require(first_way + 2.0);
  Random random(seed, 5);
  std::vector<double> limit = allowed(path, streets, parameters);
  struct Stop {
    double way, seconds;
  };
  std::vector<Stop> stops;
  for (const LanePath::Stretch& stretch : path.stretches()) {
    const bool stop = random.chance(parameters.stop_chance);
    const double wait = random.uniform(parameters.shortest_stop, parameters.longest_stop);
    const double line = std::floor(stretch.stop_line);
    if (!stop || line < first_way + 30.0 || line + 2.0 > path.length()) continue;
    stops.push_back({line, wait});
    limit[static_cast<std::size_t>(line)] = 0.0;
  }
  respect_accelerations(limit, parameters);
  double way = first_way;
  auto stop = stops.begin();
  const auto count = static_cast<std::size_t>((seconds + 2.0) / control_interval) + 4;
  while (speed_.size() < count) {
    require(way + 2.0);
    if (stop != stops.end() && way > stop->way - 0.3) {
      speed_.insert(speed_.end(), static_cast<std::size_t>(stop->seconds / control_interval), 0.0);
      way = stop->way + 0.3;
      ++stop;
      continue;
    }
    speed_.push_back(std::max(0.5, value_at(limit, way)));
    way += control_interval * speed_.back();
  }
  smooth(speed_, speed_smoothing);
  way_.push_back(first_way);
  for (std::size_t i = 0; i + 3 < speed_.size(); ++i)
    way_.push_back(way_.back() +
                   control_interval *
                       (speed_[i] + 11.0 * speed_[i + 1] + 11.0 * speed_[i + 2] + speed_[i + 3]) /
                       24.0);
}

SpeedProfile::Place SpeedProfile::place(double t) const {
  // The first second of control points precedes the drive, because some sensors look back a little.
  const double u = std::max(0.0, t + 1.0) / control_interval;
  const auto i = std::min(static_cast<std::size_t>(u), speed_.size() - 4);
  return {i, u - static_cast<double>(i)};
}

double SpeedProfile::way(double t) const {
  const auto [i, x] = place(t);
  const double a = speed_[i], b = speed_[i + 1], c = speed_[i + 2], d = speed_[i + 3];
  const double y = 1.0 - x;
  const double integral =
      a * (1.0 - y * y * y * y) / 4.0 + b * (0.75 * x * x * x * x - 2.0 * x * x * x + 4.0 * x) +
      c * (-0.75 * x * x * x * x + x * x * x + 1.5 * x * x + x) + d * x * x * x * x / 4.0;
  return way_[i] + control_interval * integral / 6.0;
}

double SpeedProfile::speed(double t) const {
  const auto [i, x] = place(t);
  const double y = 1.0 - x;
  return (y * y * y * speed_[i] + (3.0 * x * x * x - 6.0 * x * x + 4.0) * speed_[i + 1] +
          (-3.0 * x * x * x + 3.0 * x * x + 3.0 * x + 1.0) * speed_[i + 2] +
          x * x * x * speed_[i + 3]) /
         6.0;
}

double SpeedProfile::acceleration(double t) const {
  const auto [i, x] = place(t);
  const double y = 1.0 - x;
  return (-y * y * speed_[i] + (3.0 * x * x - 4.0 * x) * speed_[i + 1] +
          (-3.0 * x * x + 2.0 * x + 1.0) * speed_[i + 2] + x * x * speed_[i + 3]) /
         (2.0 * control_interval);
}

}  // namespace maploop::simulate
