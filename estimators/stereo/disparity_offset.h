// The error of the rectification is estimated here from the stereo pairs.
#pragma once

#include "estimators/stereo/parameters.h"

namespace maploop::stereo {

// Estimates a constant offset of all disparities: true = measured + value. A convergence error of
// 0.02 degrees in the rectification causes 0.25 px at KITTI's focal length, which is 1 % of the
// distance travelled if the points are 15 m away. It is observable while driving: with a wrong
// offset, near points and far points disagree about the motion. Not thread-safe.
class DisparityOffset {
 public:
  explicit DisparityOffset(const StereoParameters& parameters);

  double value() const { return value_; }  // px
  double sigma() const { return sigma_; }  // px

  // Adds a random walk of disparity_offset_drift over `seconds`.
  void predict(double seconds);

  // Fuses one pair's own estimate of the remaining offset: `correction` px with standard deviation
  // `correction_sigma` from `inliers` features. It ignores pairs in which the offset is hardly
  // observable (at standstill, or with few or only far points), and pairs that contradict the
  // present estimate by more than three standard deviations.
  void update(double correction, double correction_sigma, int inliers);

  template <class Archive>
  void archive(Archive& ar) {
    ar(value_, sigma_);
  }

 private:
  double value_ = 0.0;
  double sigma_;
  double drift_;
  double worst_sigma_;
  int min_inliers_;
};

}  // namespace maploop::stereo
