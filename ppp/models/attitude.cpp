#include "ppp/models/attitude.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace maploop::ppp {

Eigen::Matrix3d nominal_attitude(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun) {
  const Eigen::Vector3d z = -satellite.normalized();
  const Eigen::Vector3d to_sun = (sun - satellite).normalized();
  const Eigen::Vector3d y = z.cross(to_sun).normalized();
  Eigen::Matrix3d r;
  r << y.cross(z), y, z;
  return r;
}

bool in_shadow(const Eigen::Vector3d& satellite, const Eigen::Vector3d& sun) {
  const Eigen::Vector3d to_sun = sun.normalized();
  const double along = satellite.dot(to_sun);
  return along < 0.0 && (satellite - along * to_sun).norm() < 6378137.0;
}

double wind_up(const Eigen::Matrix3d& R_ecef_body, const Eigen::Matrix3d& R_enu_ecef,
               const Eigen::Vector3d& receiver_to_satellite, double before) {
  const Eigen::Vector3d k = -receiver_to_satellite.normalized();
  const Eigen::Vector3d xs = R_ecef_body.col(0), ys = R_ecef_body.col(1);
  const Eigen::Vector3d xr = R_enu_ecef.row(1), yr = -R_enu_ecef.row(0);  // north, west
  const Eigen::Vector3d ds = xs - k * k.dot(xs) - k.cross(ys);
  const Eigen::Vector3d dr = xr - k * k.dot(xr) + k.cross(yr);
  const double cosine = std::clamp(ds.dot(dr) / (ds.norm() * dr.norm()), -1.0, 1.0);
  double cycles = std::acos(cosine) / (2.0 * std::numbers::pi);
  if (k.dot(ds.cross(dr)) < 0.0) cycles = -cycles;
  return cycles + std::floor(before - cycles + 0.5);
}

}  // namespace maploop::ppp
