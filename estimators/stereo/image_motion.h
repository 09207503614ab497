// The motion of the image, and the share of it that the camera's translation causes, are measured
// here.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

struct ImageMotion {
  double flow = 0.0;      // px, median change of the left positions
  double parallax = 0.0;  // px, median of the change that rotation does not explain
};

// Measures the tracks in `chosen`; returns zeros if there are none.
ImageMotion image_motion(const StereoCalibration& camera, std::span<const StereoTrack> tracks,
                         std::span<const int> chosen, const Eigen::Isometry3d& T_previous_current);

}  // namespace maploop::stereo
