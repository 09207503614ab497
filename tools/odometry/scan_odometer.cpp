#include "tools/odometry/scan_odometer.h"

#include <utility>

namespace maploop::odometry {
namespace {

LidarScan copy_of(const lidar::ScanView& view) {
  LidarScan scan;
  static_cast<Sample&>(scan) = view;
  scan.start = view.start;
  scan.end = view.end;
  scan.points.reserve(view.count);
  for (std::size_t i = 0; i < view.count; ++i) {
    const Eigen::Vector3f point = view[i];
    scan.points.push_back({point.x(), point.y(), point.z(), 0.0f});
  }
  return scan;
}

}  // namespace

// The motion is known only after two scans; then both are processed again with it.
lidar::OdometerResult ScanOdometer::process(const std::optional<lidar::ScanView>& scan,
                                            std::span<const float> times,
                                            const VisualMotion* visual) {
  if (!scan || times.empty()) return odometer_.process(scan, visual);
  TimedScan now{copy_of(*scan), {times.begin(), times.end()}};
  const bool known = twist_.has_value();
  lidar::OdometerResult result = process(now);
  if (!known && twist_) {
    odometer_ = make_();
    process(before_);
    result = process(now);
  }
  if (!twist_) before_ = std::move(now);
  return result;
}

// Moves the points to the scan's stamp by the last motion to second order, as ScanPreparation does
// with times derived from azimuths.
lidar::OdometerResult ScanOdometer::process(const TimedScan& timed) {
  const lidar::Twist motion = twist_.value_or(lidar::Twist{});
  const Eigen::Vector3f v = motion.velocity.cast<float>(), w = motion.rate.cast<float>();
  deskewed_ = timed.scan;
  for (std::size_t i = 0; i < deskewed_.points.size(); ++i) {
    LidarPoint& p = deskewed_.points[i];
    const float t = timed.times[i];
    const Eigen::Vector3f x(p.x, p.y, p.z);
    const Eigen::Vector3f moved = x + t * (v + w.cross(x + (0.5F * t) * (w.cross(x) + v)));
    p = {moved.x(), moved.y(), moved.z(), p.reflectance};
  }
  const lidar::OdometerResult result = odometer_.process(&deskewed_, nullptr);
  const LidarMotion& m = result.lidar;
  if (m.status == OdometryStatus::ok)
    twist_ = lidar::Twist::of(m.T_from_to(), to_seconds(m.stamp - m.from));
  return result;
}

}  // namespace maploop::odometry
