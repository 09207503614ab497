// Why a pair cannot be used, by name (internal: uses OpenCV).
#pragma once

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/stereo_match.h"
#include "msgs/odometry.h"

namespace maploop::stereo {

// Of a pair that shows fewer than min_tracks features:
//   too_dark: its left image is darker than dark_level;
//   swapped_images: with left and right exchanged it shows enough of them;
//   too_few_features: otherwise.
OdometryStatus why_few_features(const StereoFrame& frame, const StereoParameters& parameters);

// Whether one of the two images has the pixels of the earlier pair's: a camera or a driver that
// sends an image again. The noise of a sensor never repeats itself.
bool repeats(const StereoFrame& frame, const StereoFrame& earlier);

}  // namespace maploop::stereo
