// The visual-LiDAR odometer joins stereo and LiDAR odometry: each supports the other.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "estimators/lidar/disparity_correction.h"
#include "estimators/lidar/lidar_odometry.h"
#include "estimators/lidar/parameters.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"

namespace maploop::lidar {

// The visual motion deskews the scan and seeds its registration (LidarOdometry); the registered
// motion teaches the constant error of the disparities (DisparityCorrection).
//
// Not thread-safe. The same input gives the same bits.
class VisualLidarOdometer {
 public:
  // `T_body_velo` transforms points of the scanner's frame to the body frame.
  VisualLidarOdometer(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters)
      : VisualLidarOdometer(LidarOdometry(T_body_velo, parameters),
                            DisparityCorrection(parameters)) {}
  // Joins an odometry, such as one that runs on several threads, and a correction.
  VisualLidarOdometer(LidarOdometry odometry, const DisparityCorrection& correction)
      : odometry_(std::move(odometry)), correction_(correction) {}

  // One step; nullptr: there is no scan, or no visual motion. With a scan, a visual motion is an
  // independent measurement and is used uncorrected. Without one it is corrected and, if it begins
  // before the end of the last step, shortened to begin there, because the motions must join.
  OdometerResult process(const LidarScan* scan, const VisualMotion* visual) {
    return process(view_of(scan), visual);
  }
  // The same for points that the caller keeps.
  OdometerResult process(const std::optional<ScanView>& scan, const VisualMotion* visual);

  // Returns the LiDAR odometry, with its map and last scan; for displays.
  const LidarOdometry& odometry() const { return odometry_; }
  // Returns the correction, with what it has learned so far.
  const DisparityCorrection& correction() const { return correction_; }

  std::size_t largest_archive() const { return odometry_.largest_archive() + 64; }  // bytes
  template <class Archive>
  void archive(Archive& ar) {
    ar(odometry_, correction_);
  }

 private:
  LidarOdometry odometry_;
  DisparityCorrection correction_;
};

}  // namespace maploop::lidar
