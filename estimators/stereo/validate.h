// What the stereo odometry accepts.
#pragma once

#include "msgs/calibration.h"
#include "msgs/image.h"

namespace maploop::stereo {

// Throws std::invalid_argument naming the value, and what it must be.
void validate(const StereoCalibration& calibration);

// Whether the image has the calibration's size, and all its pixels.
bool has_size(const GreyImage& image, const StereoCalibration& calibration);

}  // namespace maploop::stereo
