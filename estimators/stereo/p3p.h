// This header computes the camera pose from three points (P3P), by the roots of a quartic.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace maploop::stereo {

struct QuarticRoots {
  int count = 0;
  std::array<double, 4> value{};
};

// Returns the real roots of c[0] x^4 + c[1] x^3 + c[2] x^2 + c[3] x + c[4]; a double root may be
// returned twice. Uses Ferrari's solution, refined by Newton's method. Returns no roots if c[0] is
// negligible against the other coefficients.
QuarticRoots solve_quartic(const std::array<double, 5>& c);

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
