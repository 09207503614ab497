#include "estimators/lidar/visual_lidar_odometer.h"

#include "estimators/lidar/scan_preparation.h"

namespace maploop::lidar {
namespace {

// Returns the part of a motion, at constant speed and rate, that lies after `from`.
RelativeMotion begun_at(Time from, RelativeMotion motion) {
  if (!(motion.from < from && from < motion.stamp)) return motion;
  const Twist twist = Twist::of(motion.T_from_to(), to_seconds(motion.stamp - motion.from));
  const Eigen::Isometry3d T = twist.over(to_seconds(motion.stamp - from));
  motion.from = from;
  motion.translation = T.translation();
  motion.rotation = Eigen::Quaterniond(T.linear()).normalized();
  return motion;
}

}  // namespace

OdometerResult VisualLidarOdometer::process(const std::optional<ScanView>& scan,
                                            const VisualMotion* visual) {
  if (visual == nullptr) return odometry_.process(scan, nullptr);
  const RelativeMotion corrected = correction_.correct(*visual);
  const RelativeMotion& used = scan ? static_cast<const RelativeMotion&>(*visual) : corrected;
  OdometerResult result = odometry_.process(scan, &used);
  if (result.lidar.status == OdometryStatus::ok) {
    correction_.learn(*visual, result.lidar);
  } else if (result.odometry.status == OdometryStatus::ok) {
    result.odometry = begun_at(result.lidar.from, corrected);
  }
  return result;
}

}  // namespace maploop::lidar
