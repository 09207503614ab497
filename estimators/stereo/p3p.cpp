#include "estimators/stereo/p3p.h"

#include <cmath>

#include "estimators/stereo/quartic.h"

namespace maploop::stereo {
namespace {

// Computes right-handed orthonormal axes from three points; returns false if they are on a line.
bool triangle_axes(const std::array<Eigen::Vector3d, 3>& p, Eigen::Matrix3d* axes) {
  const Eigen::Vector3d first = p[1] - p[0];
  const Eigen::Vector3d normal = first.cross(p[2] - p[0]);
  const double scale = std::max(first.norm(), (p[2] - p[0]).norm());
  if (!(normal.norm() > 1e-6 * scale * scale)) return false;
  axes->col(0) = first.normalized();
  axes->col(2) = normal.normalized();
  axes->col(1) = axes->col(2).cross(axes->col(0));
  return true;
}

}  // namespace

P3pSolutions solve_p3p(const std::array<Eigen::Vector3d, 3>& points,
                       const std::array<Eigen::Vector3d, 3>& bearings) {
  P3pSolutions solutions;
  Eigen::Matrix3d world_axes;
  if (!triangle_axes(points, &world_axes)) return solutions;

  const double b2 = (points[0] - points[2]).squaredNorm();
  const double a2 = (points[1] - points[2]).squaredNorm() / b2;  // sides in units of b
  const double c2 = (points[0] - points[1]).squaredNorm() / b2;
  const double cos_a = bearings[1].dot(bearings[2]);
  const double cos_b = bearings[0].dot(bearings[2]);
  const double cos_c = bearings[0].dot(bearings[1]);
  const double difference = a2 - c2;
  const double sum = a2 + c2;

  const QuarticRoots roots = solve_quartic(
      {(difference - 1.0) * (difference - 1.0) - 4.0 * c2 * cos_a * cos_a,
       4.0 * (difference * (1.0 - difference) * cos_b - (1.0 - sum) * cos_a * cos_c +
              2.0 * c2 * cos_a * cos_a * cos_b),
       2.0 * (difference * difference - 1.0 + 2.0 * difference * difference * cos_b * cos_b +
              2.0 * (1.0 - c2) * cos_a * cos_a - 4.0 * sum * cos_a * cos_b * cos_c +
              2.0 * (1.0 - a2) * cos_c * cos_c),
       4.0 * (-difference * (1.0 + difference) * cos_b + 2.0 * a2 * cos_c * cos_c * cos_b -
              (1.0 - sum) * cos_a * cos_c),
       (1.0 + difference) * (1.0 + difference) - 4.0 * a2 * cos_c * cos_c});

  for (int i = 0; i < roots.count; ++i) {
    const double v = roots.value[static_cast<std::size_t>(i)];  // s3 / s1
    const double denominator = 2.0 * (cos_c - v * cos_a);
    if (v <= 0.0 || std::abs(denominator) < 1e-12) continue;
    const double u =  // s2 / s1
        ((difference - 1.0) * v * v - 2.0 * difference * cos_b * v + 1.0 + difference) /
        denominator;
    const double s1_squared = b2 / (1.0 + v * v - 2.0 * v * cos_b);
    if (!(u > 0.0) || !(s1_squared > 0.0)) continue;
    const double s1 = std::sqrt(s1_squared);
    const std::array<Eigen::Vector3d, 3> in_camera = {s1 * bearings[0], u * s1 * bearings[1],
                                                      v * s1 * bearings[2]};
    Eigen::Matrix3d camera_axes;
    if (!triangle_axes(in_camera, &camera_axes)) continue;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = camera_axes * world_axes.transpose();
    pose.translation() = in_camera[0] - pose.linear() * points[0];
    solutions.T_camera_world[static_cast<std::size_t>(solutions.count++)] = pose;
  }
  return solutions;
}

}  // namespace maploop::stereo
