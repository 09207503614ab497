// These functions find out why a pair cannot be used (internal: uses OpenCV).
#pragma once

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/stereo_match.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// Returns the reason why a pair shows fewer than min_tracks features:
//   too_dark: its left image is darker than dark_level;
//   swapped_images: it shows enough features if left and right are exchanged;
//   too_few_features: otherwise.
OdometryStatus why_few_features(const StereoFrame& frame, const StereoParameters& parameters);

// Returns whether one of the two images has the same pixels as in the earlier pair, which happens
// if a camera or a driver sends an image again. The noise of a sensor never repeats.
bool repeats(const StereoFrame& frame, const StereoFrame& earlier);

}  // namespace maploop::stereo
