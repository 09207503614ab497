#include "ppp/models/geodesy.h"

#include <cmath>

namespace maploop::ppp {
namespace {
constexpr double semi_major = 6378137.0;
constexpr double flattening = 1.0 / 298.257223563;
constexpr double e2 = flattening * (2.0 - flattening);
}  // namespace

Geodetic geodetic_from_ecef(const Eigen::Vector3d& p) {
  const double r2 = p.x() * p.x() + p.y() * p.y();
  double z = p.z(), before = 0.0, curvature = semi_major;
  for (int i = 0; i < 20 && std::abs(z - before) > 1e-4; ++i) {
    before = z;
    const double s = z / std::sqrt(r2 + z * z);
    curvature = semi_major / std::sqrt(1.0 - e2 * s * s);
    z = p.z() + curvature * e2 * s;
  }
  return {std::atan2(z, std::sqrt(r2)), std::atan2(p.y(), p.x()),
          std::sqrt(r2 + z * z) - curvature};
}

Eigen::Vector3d ecef_from_geodetic(const Geodetic& g) {
  const double s = std::sin(g.latitude), c = std::cos(g.latitude);
  const double curvature = semi_major / std::sqrt(1.0 - e2 * s * s);
  return {(curvature + g.height) * c * std::cos(g.longitude),
          (curvature + g.height) * c * std::sin(g.longitude),
          (curvature * (1.0 - e2) + g.height) * s};
}

Eigen::Matrix3d rotation_enu_ecef(const Geodetic& g) {
  const double sp = std::sin(g.latitude), cp = std::cos(g.latitude);
  const double sl = std::sin(g.longitude), cl = std::cos(g.longitude);
  Eigen::Matrix3d r;
  r << -sl, cl, 0.0, -sp * cl, -sp * sl, cp, cp * cl, cp * sl, sp;
  return r;
}

}  // namespace maploop::ppp
