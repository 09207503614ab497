// This header computes the camera pose from three points (P3P).
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace maploop::stereo {

struct P3pSolutions {
  int count = 0;  // 0 to 4; 0 also if the points are on a line
  std::array<Eigen::Isometry3d, 4> T_camera_world;
};

// Returns all poses that see `points` (world, m) along `bearings` (camera, unit vectors) in front
// of the camera. Solves Grunert's quartic in the form of Haralick et al., "Review and Analysis of
// Solutions of the Three Point Perspective Pose Estimation Problem", IJCV 13 (1994), eq. 8 and 9.
P3pSolutions solve_p3p(const std::array<Eigen::Vector3d, 3>& points,
                       const std::array<Eigen::Vector3d, 3>& bearings);

}  // namespace maploop::stereo
