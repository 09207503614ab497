// This file finds how a LiDAR is placed against the cameras from the ground that both see.
#pragma once

#include <optional>
#include <span>

#include "msgs/calibration.h"
#include "tools/calibrate/extrinsics/lever.h"
#include "tools/calibrate/extrinsics/sensor_views.h"

namespace maploop::extrinsics {

// Stereo points of the ground lie on the scan's ground:
//   n^T (R^T (p_cam(u, v, d + o) - p) - q) = 0
// for the LiDAR's pose (R, p) in the camera's axes (right, down, ahead), the scan's nearest surface
// point q, whose normal n is upright within 25 degrees, and a constant error o of the disparities.
// That shows how far down the LiDAR is, and its turns about the camera's right and ahead; the rest
// of the pose is kept. Walls are left out: real images have errors of disparity that vary over the
// columns, which put walls to a wrong place. Returns nothing if there are too few points.
std::optional<HandEye> align_ground(std::span<const ViewPair> views,
                                    const StereoCalibration& camera, HandEye pose);

}  // namespace maploop::extrinsics
