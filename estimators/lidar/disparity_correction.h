// The length of visual motions is corrected here by that of LiDAR odometry.
#pragma once

#include "estimators/lidar/parameters.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"

namespace maploop::lidar {

// A rectification error makes all disparities too small or too large, and all distances too long or
// too short. The difference between the motions of LiDAR and visual odometry over the same time
// shows the constant error of the disparities. This class filters it and corrects visual motions
// without a LiDAR motion by it, so that the length stays right where LiDAR odometry fails. Motions
// are compared, not depths, because a feature lies on an edge, and the depth beside an edge is
// often not that of the feature.
//
// Not thread-safe. The same input gives the same bits. Never allocates.
class DisparityCorrection {
 public:
  explicit DisparityCorrection(const LidarParameters& parameters);

  // Returns the motion and its covariance with corrected disparities. Motions that are not ok, or
  // whose dependence on the disparities is unknown, are not changed; nor is any motion before the
  // first call of learn() that had an effect.
  RelativeMotion correct(const VisualMotion& visual) const;

  // Learns from the uncorrected `visual` and the LiDAR's motion over the same time. Motions that
  // are not ok, have different stamps, are not determined along the path by the scan, or hardly
  // depend on the disparities (standing car) have no effect.
  void learn(const VisualMotion& visual, const LidarMotion& lidar);

  // These return the remaining offset of every measured disparity, px, and its standard deviation.
  double offset() const { return offset_; }
  double sigma() const { return sigma_; }
  int motions() const { return motions_; }  // number of motions that had an effect

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

}  // namespace maploop::lidar
