#include "estimators/stereo/p3p.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

// Returns the largest real root of x^3 + a x^2 + b x + c.
double largest_cubic_root(double a, double b, double c) {
  const double q = (a * a - 3.0 * b) / 9.0;
  const double r = (2.0 * a * a * a - 9.0 * a * b + 27.0 * c) / 54.0;
  if (r * r < q * q * q) {
    const double angle = std::acos(std::clamp(r / std::sqrt(q * q * q), -1.0, 1.0));
    return -2.0 * std::sqrt(q) * std::cos((angle + 2.0 * std::numbers::pi) / 3.0) - a / 3.0;
  }
  const double s = -std::copysign(std::cbrt(std::abs(r) + std::sqrt(r * r - q * q * q)), r);
  return s + (s == 0.0 ? 0.0 : q / s) - a / 3.0;
}

double polish(const std::array<double, 5>& c, double x) {
  for (int i = 0; i < 2; ++i) {
    const double value = (((c[0] * x + c[1]) * x + c[2]) * x + c[3]) * x + c[4];
    const double slope = ((4.0 * c[0] * x + 3.0 * c[1]) * x + 2.0 * c[2]) * x + c[3];
    const double step = value / slope;
    if (!std::isfinite(step)) break;
    x -= step;
  }
  return x;
}

}  // namespace

QuarticRoots solve_quartic(const std::array<double, 5>& c) {
  QuarticRoots roots;
  const double largest = std::abs(*std::max_element(
      c.begin(), c.end(), [](double x, double y) { return std::abs(x) < std::abs(y); }));
  if (!std::isfinite(largest) || !(std::abs(c[0]) > 1e-12 * largest)) return roots;

  // The depressed quartic is y^4 + p y^2 + q y + r with x = y - shift.
  const double a = c[1] / c[0], b = c[2] / c[0], d = c[3] / c[0], e = c[4] / c[0];
  const double shift = a / 4.0;
  const double p = b - 6.0 * shift * shift;
  const double q = d - 2.0 * b * shift + 8.0 * shift * shift * shift;
  const double r = e - d * shift + b * shift * shift - 3.0 * shift * shift * shift * shift;

  // It factors into (y^2 + m y + n)(y^2 - m y + l), where m^2 is the largest root of the resolvent
  // cubic.
  const double m2 = std::max(0.0, largest_cubic_root(2.0 * p, p * p - 4.0 * r, -q * q));
  const double m = std::sqrt(m2);
  const double tiny = 1e-12 * (std::abs(p) + std::sqrt(std::abs(r)));
  const double inner = p * p / 4.0 - r;
  const double split =
      m2 > tiny ? q / (2.0 * m) : -std::sqrt(std::max(0.0, inner));  // q = 0: biquadratic
  const double n = (p + m2) / 2.0 - split;
  const double l = (p + m2) / 2.0 + split;
  for (const auto& [linear, constant] : {std::array{m, n}, std::array{-m, l}}) {
    const double discriminant = linear * linear / 4.0 - constant;
    if (!(discriminant >= 0.0)) continue;
    for (const double sign : {-1.0, 1.0})
      roots.value[static_cast<std::size_t>(roots.count++)] =
          polish(c, -linear / 2.0 + sign * std::sqrt(discriminant) - shift);
  }
  return roots;
}

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
