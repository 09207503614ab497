#include "runtime/vehicle/faults/scan_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "msgs/frames.h"
#include "sensors/replay/normal_generator.h"

namespace maploop::vehicle {
namespace {

double range_of(const LidarPoint& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

// Moves a point along its beam; one in the scanner itself stays there.
void set_range(LidarPoint& p, double range) {
  const double before = range_of(p);
  if (before <= 0.0) return;
  const auto factor = static_cast<float>(range / before);
  p.x *= factor;
  p.y *= factor;
  p.z *= factor;
}

// Takes away the points for which `lost` is true, and their times.
void erase_points(LidarScan& scan, const auto& lost) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (lost(scan.points[i])) continue;
    scan.points[kept] = scan.points[i];
    if (!scan.times.empty()) scan.times[kept] = scan.times[i];
    ++kept;
  }
  scan.points.resize(kept);
  if (!scan.times.empty()) scan.times.resize(kept);
}

}  // namespace

void fill_with_nan(LidarScan& scan) {
  constexpr float f = std::numeric_limits<float>::quiet_NaN();
  std::fill(scan.points.begin(), scan.points.end(), LidarPoint{f, f, f, f});
}

void roughen(LidarScan& scan, double sigma, std::uint64_t seed) {
  sensors::NormalGenerator random(seed, scan.stamp);
  for (LidarPoint& p : scan.points)
    set_range(p, std::max(0.0, range_of(p) + sigma * random.next()));
}

void turn(LidarScan& scan, double angle) {
  const auto sine = static_cast<float>(std::sin(angle));
  const auto cosine = static_cast<float>(std::cos(angle));
  for (LidarPoint& p : scan.points) {
    const float x = p.x;
    p.x = cosine * x + sine * p.y;
    p.y = cosine * p.y - sine * x;
  }
}

void block(LidarScan& scan, double width) {
  erase_points(scan, [width](const LidarPoint& p) {
    return std::abs(std::atan2(p.y, p.x)) <= static_cast<float>(0.5 * width);
  });
}

void rain_on(LidarScan& scan, double drops, std::uint64_t seed) {
  constexpr double nearest = 1.0, farthest = 6.0, far = 20.0;  // m
  sensors::NormalGenerator random(seed, scan.stamp);
  erase_points(scan, [&](LidarPoint& p) {
    const double range = range_of(p);
    if (random.uniform(0.0, 1.0) < drops) {
      set_range(p, std::min(range, random.uniform(nearest, farthest)));
      return false;
    }
    return range > far && random.uniform(0.0, 1.0) < drops;
  });
}

void distort(LidarScan& scan, const Strike& strike) {
  using enum FaultKind;
  switch (strike.kind) {
    case nan:
      return fill_with_nan(scan);
    case noise:
      return roughen(scan, strike.by, strike.seed);
    case bumped:
      return turn(scan, radians(strike.by));
    case blocked:
      return block(scan, radians(strike.by));
    case rain:
      return rain_on(scan, strike.by, strike.seed);
    default:
      return;
  }
}

}  // namespace maploop::vehicle
