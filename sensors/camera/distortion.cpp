#include "sensors/camera/distortion.h"

#include <Eigen/Dense>

namespace maploop::sensors {

DistortedPoint apply(const Distortion& d, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = 1.0 + d.k1 * r2 + d.k2 * r4 + d.k3 * r6;
  const double by_r2 = d.k1 + 2.0 * d.k2 * r2 + 3.0 * d.k3 * r4;
  DistortedPoint out;
  out.point << x * radial + 2.0 * d.p1 * x * y + d.p2 * (r2 + 2.0 * x * x),
      y * radial + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * x * y;
  const double mixed = 2.0 * x * y * by_r2 + 2.0 * d.p1 * x + 2.0 * d.p2 * y;
  out.by_point << radial + 2.0 * x * x * by_r2 + 2.0 * d.p1 * y + 6.0 * d.p2 * x, mixed,  //
      mixed, radial + 2.0 * y * y * by_r2 + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  out.by_coefficients << x * r2, x * r4, 2.0 * x * y, r2 + 2.0 * x * x, x * r6,  //
      y * r2, y * r4, r2 + 2.0 * y * y, 2.0 * x * y, y * r6;
  return out;
}

Distortion fit_distortion(const std::vector<Eigen::Vector2d>& from,
                          const std::vector<Eigen::Vector2d>& to) {
  const auto rows = static_cast<Eigen::Index>(2 * from.size());
  Eigen::Matrix<double, Eigen::Dynamic, 5> a(rows, 5);
  Eigen::VectorXd b(rows);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    a.middleRows<2>(row) = apply({}, from[i]).by_coefficients;
    b.segment<2>(row) = to[i] - from[i];
  }
  const Eigen::Matrix<double, 5, 1> k = a.colPivHouseholderQr().solve(b);
  return {k[0], k[1], k[2], k[3], k[4]};
}

}  // namespace maploop::sensors
