// How much the image moved, and how much of it because the camera went somewhere.
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

struct ImageMotion {
  double flow = 0.0;      // px, median of the left positions' change
  double parallax = 0.0;  // px, median of what the rotation does not explain of it
};

// Of the tracks named; zero where there are none.
ImageMotion image_motion(const StereoCalibration& camera, std::span<const StereoTrack> tracks,
                         std::span<const int> chosen, const Eigen::Isometry3d& T_previous_current);

}  // namespace maploop::stereo
