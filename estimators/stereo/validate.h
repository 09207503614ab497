// What the stereo odometry accepts.
#pragma once

#include "estimators/stereo/parameters.h"
#include "msgs/calibration.h"
#include "msgs/image.h"

namespace maploop::stereo {

// Throw std::invalid_argument naming the value, and what it must be.
void validate(const StereoCalibration& calibration);
void validate(const StereoParameters& parameters);

// Whether the image has the calibration's size, and all its pixels.
bool has_size(const GreyImage& image, const StereoCalibration& calibration);

}  // namespace maploop::stereo
