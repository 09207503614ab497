// What the stereo pairs themselves say about their rectification.
#pragma once

#include "estimators/stereo/parameters.h"

namespace maploop::stereo {

// A constant that is missing in every disparity: true = measured + value. A rectification that is
// off by 0.02 degrees of convergence makes 0.25 px at KITTI's focal length, and that is 1 % of the
// way driven when the points are 15 m away. While driving it can be seen: with a wrong offset near
// points and far points disagree about the motion.
class DisparityOffset {
 public:
  explicit DisparityOffset(const StereoParameters& parameters);

  double value() const { return value_; }  // px
  double sigma() const { return sigma_; }  // px

  // Random walk of disparity_offset_drift over `seconds`.
  void predict(double seconds);

  // One pair's own estimate of what is still missing, `correction` px with standard deviation
  // `correction_sigma` from `inliers` features. Pairs that hardly see the offset (standing, few or
  // only far points) are left out, and so are those that contradict what is known by more than
  // three standard deviations.
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
