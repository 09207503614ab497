// The normals of a scan's samples are computed here.
#pragma once

#include <vector>

#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_moments.h"

namespace maploop::lidar {

// Computes one point per voxel, at the mean of its points (m). The normal is the direction in which
// the points of the voxel and its six neighbours spread least. A voxel gives no point if its
// neighbourhood holds fewer than `min_points` points or only points of one line.
void surface_points(const VoxelMoments& moments, int min_points, std::vector<SurfacePoint>* points);

}  // namespace maploop::lidar
