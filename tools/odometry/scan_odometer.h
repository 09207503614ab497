// Runs LiDAR odometry on scans whose points may have times of their own.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "estimators/lidar/scan_preparation.h"
#include "estimators/lidar/visual_lidar_odometer.h"
#include "msgs/lidar_scan.h"

namespace maploop::odometry {

// Not thread-safe. The same input gives the same bits.
class ScanOdometer {
 public:
  // `make` returns an odometer at its start.
  explicit ScanOdometer(std::function<lidar::VisualLidarOdometer()> make)
      : make_(std::move(make)), odometer_(make_()) {}

  // One step, as VisualLidarOdometer::process(). `times` are those of the points in seconds after
  // the scan's stamp; if they are empty, the odometer derives them from azimuths. A scan with times
  // is used without a visual motion.
  lidar::OdometerResult process(const std::optional<lidar::ScanView>& scan,
                                std::span<const float> times, const VisualMotion* visual);

  const lidar::VisualLidarOdometer& odometer() const { return odometer_; }
  // The points of the last scan with times, moved to its stamp.
  const LidarScan& deskewed() const { return deskewed_; }

 private:
  struct TimedScan {
    LidarScan scan;
    std::vector<float> times;
  };
  lidar::OdometerResult process(const TimedScan& timed);

  std::function<lidar::VisualLidarOdometer()> make_;
  lidar::VisualLidarOdometer odometer_;
  std::optional<lidar::Twist> twist_;  // the last motion
  TimedScan before_;                   // until the motion is known
  LidarScan deskewed_;
};

}  // namespace maploop::odometry
