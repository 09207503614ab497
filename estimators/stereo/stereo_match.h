// The right camera's view of left features is found here (internal: uses OpenCV).
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

// Matches new corners: searches along the row of the half-size images, then applies Lucas-Kanade to
// the right image and back. Skips points whose rows differ, whose way back ends elsewhere, or whose
// disparity is out of range.
void match_new_corners(const StereoFrame& frame, const StereoParameters& parameters,
                       const std::vector<cv::Point2f>& corners,
                       std::vector<StereoObservation>* matched);

// Returns whether the two views can show one point: the rows agree and the disparity is in range.
bool consistent(const StereoObservation& seen, const StereoParameters& parameters);

}  // namespace maploop::stereo
