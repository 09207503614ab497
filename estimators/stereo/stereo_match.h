// The right camera's view of left features (internal: uses OpenCV).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "estimators/stereo/image_pyramid.h"
#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"

namespace maploop::stereo {

struct StereoFrame {
  ImagePyramid left;
  ImagePyramid right;
};

// Stereo match of new corners: search along the row of the half-size images, then Lucas-Kanade to
// the right image and back. Points whose rows differ, whose way back ends elsewhere or whose
// disparity is out of range are left out.
void match_new_corners(const StereoFrame& frame, const StereoParameters& parameters,
                       const std::vector<cv::Point2f>& corners,
                       std::vector<StereoObservation>* matched);

// Whether the two views can be one point: same row, disparity in range.
bool consistent(const StereoObservation& seen, const StereoParameters& parameters);

}  // namespace maploop::stereo
