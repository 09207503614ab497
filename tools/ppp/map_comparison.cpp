#include "tools/ppp/map_comparison.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "msgs/protection_levels.h"
#include "ppp/models/geodesy.h"

namespace maploop::gnss {

using namespace maploop::ppp;

void MapComparison::add(const PppSolution& aided, const PppSolution& free) {
  if (!from_) from_ = aided.time;
  const auto truth = truth_.at(aided.time), before = truth_.at(aided.time - from_seconds(1.0));
  if (aided.time < *from_ || !truth || !before || aided.status == PppStatus::none ||
      free.status == PppStatus::none)
    return;
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(*truth));
  const TravelAxes axes = travel_axes(R * (*truth - *before));
  if (!axes.known) return;
  const Eigen::Matrix2d P = (R * free.covariance * R.transpose()).topLeftCorner<2, 2>();
  const double sigma = std::sqrt(axes.across.dot(P * axes.across));
  epochs_ += sigma > useful ? 1 : 0;
  const auto count = [&](const PppSolution& solution, Sums& sums) {
    const Eigen::Vector2d error = (R * (solution.position - *truth)).head<2>();
    const double across = axes.across.dot(error);
    if (std::abs(across) > stays_below) sums.above = solution.time;
    if (sigma <= useful) return;
    sums.across += across * across;
    sums.horizontal += error.squaredNorm();
  };
  count(aided, aided_);
  count(free, free_);
}

MapComparison::Errors MapComparison::errors_of(const Sums& sums) const {
  const auto n = static_cast<double>(std::max<std::size_t>(1, epochs_));
  const double above = from_ ? to_seconds(sums.above - *from_) : 0.0;
  return {std::sqrt(sums.across / n), std::sqrt(sums.horizontal / n), std::max(0.0, above)};
}

}  // namespace maploop::gnss
