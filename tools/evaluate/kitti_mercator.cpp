#include "tools/evaluate/kitti_mercator.h"

#include <cmath>

namespace maploop::evaluation {

Trajectory from_kitti_mercator(const Trajectory& poses, double latitude, double azimuth) {
  constexpr double e2 = 0.00669437999014;
  const double w2 = 1.0 - e2 * std::pow(std::sin(latitude), 2);
  const double east_scale = 1.0 / std::sqrt(w2);              // prime vertical by KITTI's sphere
  const double north_scale = (1.0 - e2) / std::pow(w2, 1.5);  // meridian by KITTI's sphere

  // Rows are east, north, up in terms of a level camera's x (right), y (down), z (ahead).
  Eigen::Matrix3d R_enu_cam;
  R_enu_cam << std::cos(azimuth), 0.0, std::sin(azimuth),  //
      -std::sin(azimuth), 0.0, std::cos(azimuth),          //
      0.0, -1.0, 0.0;
  const Eigen::Matrix3d stretch = R_enu_cam.transpose() *
                                  Eigen::Vector3d(east_scale, north_scale, 1.0).asDiagonal() *
                                  R_enu_cam;
  Trajectory metric;
  for (const Eigen::Isometry3d& pose : poses) {
    metric.push_back(poses.front().inverse() * pose);
    metric.back().translation() = stretch * metric.back().translation();
  }
  return metric;
}

}  // namespace maploop::evaluation
