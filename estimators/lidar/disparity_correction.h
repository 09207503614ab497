// Visual motions, given the length that LiDAR odometry has.
#pragma once

#include "estimators/lidar/lidar_odometry.h"
#include "estimators/lidar/parameters.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"

namespace maploop::lidar {

// A rectification that is off makes all disparities too small or too large, and all ways too long
// or too short. What constant the disparities lack shows in the motions that LiDAR and visual
// odometry find over the same time; it is filtered, and visual motions that stand alone are
// corrected by it, so that the length stays right where LiDAR odometry fails. Motions are compared,
// not depths: a feature stands at an edge, and the depth beside it is often not its own.
//
// Not thread-safe; the same input gives the same bits. Never allocates.
class DisparityCorrection {
 public:
  explicit DisparityCorrection(const LidarParameters& parameters);

  // The motion and its covariance, as they would be with the disparities corrected. Motions that
  // are not ok, or of which it is not known how they depend on the disparities, stay as they are;
  // so do all before the first that taught something.
  RelativeMotion correct(const VisualMotion& visual) const;

  // From `visual` as it came and the LiDAR's motion over the same time. What is not ok, of other
  // stamps, not determined along the way by the scan, or hardly shows the disparities (a standing
  // car), teaches nothing.
  void learn(const VisualMotion& visual, const LidarMotion& lidar);

  // Missing in every disparity as it is measured, px, and its standard deviation.
  double offset() const { return offset_; }
  double sigma() const { return sigma_; }
  int motions() const { return motions_; }  // that taught something

  template <class Archive>
  void archive(Archive& ar) {
    ar.section("disparity correction", 1);
    ar(offset_, sigma_, motions_, last_);
  }

 private:
  bool wanted_;
  double drift_, least_sigma_;
  double offset_ = 0.0, sigma_ = 0.0;
  int motions_ = 0;
  Time last_{};
};

// One step of both: LidarOdometry::process, which also teaches the correction. Beside a scan that
// can be used, a visual motion is a witness of its own and goes in as it came; alone it is
// corrected, and cut off at the last step where it reaches back behind that: the motions are a
// chain.
OdometerResult process(LidarOdometry& odometry, DisparityCorrection& correction,
                       const LidarScan* scan, const VisualMotion* visual);

}  // namespace maploop::lidar
