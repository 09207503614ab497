// Normals of a scan's samples.
#pragma once

#include <vector>

#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_moments.h"

namespace maploop::lidar {

// One point a voxel, at the mean of what it holds; its normal is the direction in which the points
// of the voxel and its six neighbours spread least. Voxels whose neighbourhood holds fewer than
// `min_points` points, or points of one line only, give none.
void surface_points(const VoxelMoments& moments, int min_points, std::vector<SurfacePoint>* points);

}  // namespace maploop::lidar
