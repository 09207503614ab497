// Computes the rectified cameras for a pair of raw cameras.
#pragma once

#include "sensors/camera/stereo_rig.h"
#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

// Each camera is turned by half of the rotation between them, then both are turned so that x points
// from the left to the right one (Bouguet). The rectified image has the raw image's size and the
// largest field of view in which the raw cameras see every pixel of both images. Throws
// std::runtime_error if the right camera is not to the right of the left one, or if no such field
// remains.
sensors::StereoRig rectify(const Cameras& cameras, int width, int height);

}  // namespace maploop::calibrate
