#include "sensors/camera/distortion.h"

#include <Eigen/Dense>
#include <cmath>

namespace maploop::sensors {

namespace {

// A value and its derivative by the square of the radius.
struct Radial {
  double value, by_r2;
};

Radial polynomial(double k1, double k2, double k3, double r2) {
  const double r4 = r2 * r2, r6 = r4 * r2;
  return {1.0 + k1 * r2 + k2 * r4 + k3 * r6, k1 + 2.0 * k2 * r2 + 3.0 * k3 * r4};
}

// Returns the factor by which the lens stretches the radius.
Radial rational(const Distortion& d, double r2) {
  const Radial above = polynomial(d.k1, d.k2, d.k3, r2), below = polynomial(d.k4, d.k5, d.k6, r2);
  return {above.value / below.value,
          (above.by_r2 * below.value - above.value * below.by_r2) / (below.value * below.value)};
}

Radial equidistant(const Distortion& d, double r2) {
  constexpr double near_axis = 1e-12;  // of r^2, where a / r is 1 - r^2 / 3
  if (r2 < near_axis) return {1.0, d.k1 - 1.0 / 3.0};
  const double r = std::sqrt(r2), a = std::atan(r), a2 = a * a;
  const double bent = a * (1.0 + a2 * (d.k1 + a2 * (d.k2 + a2 * (d.k3 + a2 * d.k4))));
  const double by_a =
      1.0 + a2 * (3.0 * d.k1 + a2 * (5.0 * d.k2 + a2 * (7.0 * d.k3 + a2 * 9.0 * d.k4)));
  return {bent / r, (by_a / (1.0 + r2) - bent / r) / (2.0 * r2)};
}

Radial radial(const Distortion& d, double r2) {
  return d.lens == Lens::equidistant ? equidistant(d, r2) : rational(d, r2);
}

}  // namespace

DistortedPoint apply(const Distortion& d, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  const double r2 = x * x + y * y;
  const auto [stretch, by_r2] = radial(d, r2);
  DistortedPoint out;
  out.point << x * stretch + 2.0 * d.p1 * x * y + d.p2 * (r2 + 2.0 * x * x),
      y * stretch + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * x * y;
  const double mixed = 2.0 * x * y * by_r2 + 2.0 * d.p1 * x + 2.0 * d.p2 * y;
  out.by_point << stretch + 2.0 * x * x * by_r2 + 2.0 * d.p1 * y + 6.0 * d.p2 * x, mixed,  //
      mixed, stretch + 2.0 * y * y * by_r2 + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  return out;
}

Eigen::Matrix<double, 2, 5> by_coefficients(const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  Eigen::Matrix<double, 2, 5> by;
  by << x * r2, x * r4, 2.0 * x * y, r2 + 2.0 * x * x, x * r6,  //
      y * r2, y * r4, r2 + 2.0 * y * y, 2.0 * x * y, y * r6;
  return by;
}

bool is_lens(const Distortion& d, const Eigen::Vector2d& x) {
  constexpr int steps = 8;
  const double r2 = x.squaredNorm();
  for (int i = 1; i <= steps; ++i) {
    const double s = r2 * i / steps;
    const auto [stretch, by_r2] = radial(d, s);
    if (!(stretch > 0.0 && stretch + 2.0 * s * by_r2 > 0.0)) return false;
  }
  return true;
}

Distortion fit_distortion(const std::vector<Eigen::Vector2d>& from,
                          const std::vector<Eigen::Vector2d>& to) {
  const auto rows = static_cast<Eigen::Index>(2 * from.size());
  Eigen::Matrix<double, Eigen::Dynamic, 5> a(rows, 5);
  Eigen::VectorXd b(rows);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    a.middleRows<2>(row) = by_coefficients(from[i]);
    b.segment<2>(row) = to[i] - from[i];
  }
  const Eigen::Matrix<double, 5, 1> k = a.colPivHouseholderQr().solve(b);
  return {.k1 = k[0], .k2 = k[1], .p1 = k[2], .p2 = k[3], .k3 = k[4]};
}

}  // namespace maploop::sensors
