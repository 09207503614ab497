// What registration compares.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "msgs/time.h"

namespace maploop::lidar {

// A piece of surface. Its covariance in the sense of GICP is I - (1 - epsilon) n n^T.
struct SurfacePoint {
  Eigen::Vector3f position;  // m
  Eigen::Vector3f normal;    // unit, either sign
};

// A scan as it would have been seen in one moment.
struct PreparedScan {
  Time stamp{};                      // that moment: points and normals are in the body frame then
  std::vector<SurfacePoint> points;  // sorted by their voxels
  int cropped = 0;                   // raw points out of range or not finite
  int left_out = 0;                  // raw points beyond what a scan may hold
};

}  // namespace maploop::lidar
