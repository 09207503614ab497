// The normals of a scan's samples are computed here.
#pragma once

#include <vector>

#include "estimators/lidar/parameters.h"
#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_moments.h"

namespace maploop::lidar {

// Computes one point per voxel, at the mean of its points (m). The normal is the direction in which
// the points of the voxel and its six neighbours spread least. The point has no normal if the
// neighbourhood holds only points of one line, or of one beam, which spread least across the beam
// whatever it hit. A voxel gives no point if its neighbourhood holds fewer than min_surface_points.
// `scanner` is the position of the scanner (m) in the axes of the voxels.
void surface_points(const VoxelMoments& moments, const Eigen::Vector3f& scanner,
                    const LidarParameters& parameters, std::vector<SurfacePoint>* points);

}  // namespace maploop::lidar
