// This file finds how a LiDAR is placed against the left camera from edges that both see.
#pragma once

#include <optional>
#include <span>

#include "msgs/calibration.h"
#include "tools/calibrate/extrinsics/lever.h"
#include "tools/calibrate/extrinsics/sensor_views.h"

namespace maploop::extrinsics {

// The scan's depth edges (depth_edges.h) lie on vertical edges of the left image (image_edges.h).
// Found are the LiDAR's turn about the camera's downward axis, and its place to the right and
// ahead, for which the image's edges are strongest on the average of all points; the rest of the
// pose is kept. Standard deviations are those that eight stretches of the drive show against each
// other. Returns nothing if there are too few edges.
std::optional<HandEye> align_edges(std::span<const ViewPair> views, const StereoCalibration& camera,
                                   HandEye pose);

}  // namespace maploop::extrinsics
