// Converts KITTI's published poses to metres.
#pragma once

#include "tools/evaluate/kitti_poses.h"

namespace maploop::evaluation {

// KITTI's ground truth is OXTS put through a spherical Mercator projection: at 49 degrees north its
// metres are 0.19 % short from east to west and 0.10 % long from north to south. Returns positions
// relative to the first pose in metres of WGS84, for a first camera that looks level to `azimuth`
// (rad, clockwise from north) at `latitude` (rad). The change of the projection along a drive is
// not corrected; it is 2e-5 in a kilometre.
Trajectory from_kitti_mercator(const Trajectory& poses, double latitude, double azimuth);

}  // namespace maploop::evaluation
