// Registration compares these surface points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "msgs/time.h"

namespace maploop::lidar {

// Describes a piece of surface. Its covariance in the sense of GICP is I - (1 - epsilon) n n^T.
struct SurfacePoint {
  Eigen::Vector3f position;  // m
  Eigen::Vector3f normal;    // unit, either sign; zero where the points do not determine it

  bool has_normal() const { return !normal.isZero(); }
};

// Holds a scan as if all its points had been measured at one time.
struct PreparedScan {
  Time stamp{};                      // that time; points and normals are in the body frame then
  std::vector<SurfacePoint> points;  // sorted by their voxels
  int cropped = 0;                   // raw points out of range or not finite
  int left_out = 0;                  // raw points beyond max_points or max_samples
};

}  // namespace maploop::lidar
