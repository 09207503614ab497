#include "msgs/protection_levels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maploop {
namespace {

double deviation(const Eigen::Matrix2d& P, const Eigen::Vector2d& direction) {
  return std::sqrt(std::max(0.0, direction.dot(P * direction)));
}

// Returns the standard deviation along the plane's largest axis.
double largest_deviation(const Eigen::Matrix2d& P) {
  const double middle = 0.5 * (P(0, 0) + P(1, 1));
  return std::sqrt(std::max(0.0, middle + std::hypot(0.5 * (P(0, 0) - P(1, 1)), P(0, 1))));
}

}  // namespace

double integrity_factor(double risk) {
  double low = 0.0, high = 40.0;  // erfc is zero beyond this
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::numbers::sqrt2) > risk ? low : high) = middle;
  }
  return high;
}

TravelAxes travel_axes(const Eigen::Vector3d& velocity_enu) {
  constexpr double slowest = 0.5;  // m/s
  const Eigen::Vector2d v = velocity_enu.head<2>();
  if (!(v.norm() >= slowest)) return {{1.0, 0.0}, {0.0, 1.0}, false};
  const Eigen::Vector2d along = v.normalized();
  return {along, {along.y(), -along.x()}, true};
}

ProtectionLevels protection_levels(const Eigen::Matrix3d& covariance_enu,
                                   const Eigen::Vector3d& velocity_enu, double factor) {
  const Eigen::Matrix2d plane = covariance_enu.topLeftCorner<2, 2>();
  const double up = factor * std::sqrt(std::max(0.0, covariance_enu(2, 2)));
  const TravelAxes axes = travel_axes(velocity_enu);
  if (!axes.known) {
    const double largest = factor * largest_deviation(plane);
    return {largest, largest, up};
  }
  return {factor * deviation(plane, axes.along), factor * deviation(plane, axes.across), up};
}

}  // namespace maploop
