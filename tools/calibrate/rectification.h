// Which rectified cameras a pair of raw ones is turned into.
#pragma once

#include "sensors/camera/stereo_rig.h"
#include "tools/calibrate/board_adjustment.h"

namespace maploop::calibrate {

// Each camera is turned by half of the rotation between them, then both so that x points from the
// left to the right one (Bouguet). The rectified image has the raw one's size, and the largest
// field of view in which every pixel of both images is one that the raw cameras see. Throws
// std::runtime_error where the right camera does not stand to the right of the left one, or
// no such field is left.
sensors::StereoRig rectify(const Cameras& cameras, int width, int height);

}  // namespace maploop::calibrate
