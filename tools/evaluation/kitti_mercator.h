// KITTI's published poses in metres.
#pragma once

#include "tools/evaluation/kitti_poses.h"

namespace maploop::evaluation {

// KITTI's ground truth is OXTS put through a spherical Mercator projection: at 49 degrees north its
// metres are 0.19 % short from east to west and 0.10 % long from north to south. Positions relative
// to the first pose in metres of WGS84, for a first camera that looks level to `azimuth` (rad,
// clockwise from north) at `latitude` (rad); the projection's own change along a drive is left: it
// is 2e-5 in a kilometre.
Trajectory from_kitti_mercator(const Trajectory& poses, double latitude, double azimuth);

}  // namespace maploop::evaluation
