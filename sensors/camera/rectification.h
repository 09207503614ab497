// This file computes the rectified cameras for a pair of raw cameras.
#pragma once

#include <Eigen/Geometry>

#include "sensors/camera/stereo_rig.h"

namespace maploop::sensors {

// Each camera is turned by half of the rotation between them, then both are turned so that x points
// from the left to the right one (Bouguet). The rectified image has the raw image's size and the
// largest field of view in which the raw cameras see every pixel of both images. Throws
// std::runtime_error if the right camera is not to the right of the left one, or if no such field
// remains.
StereoRig rectify(const CameraModel& left, const CameraModel& right,
                  const Eigen::Isometry3d& T_right_left, int width, int height);

}  // namespace maploop::sensors
