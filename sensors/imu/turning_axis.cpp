#include "sensors/imu/turning_axis.h"

#include <algorithm>
#include <cmath>

namespace maploop::sensors {

void TurningAxis::add(const Eigen::Vector3d& rate, double course_rate, double weight) {
  weights_ += weight;
  rates_ += weight * rate;
  course_rates_ += weight * course_rate;
  products_ += weight * course_rate * rate;
  course_squares_ += weight * course_rate * course_rate;
  rate_squares_ += weight * rate.squaredNorm();
}

TurningAxis::Line TurningAxis::line() const {
  constexpr double parameters = 2.0;  // of a line, along each axis
  const double spread = course_squares_ - course_rates_ * course_rates_ / weights_;
  Line line;
  if (weights_ <= parameters || !(spread > 0.0)) return line;
  line.axis = (products_ - course_rates_ / weights_ * rates_) / spread;
  const double residuals =
      rate_squares_ - rates_.squaredNorm() / weights_ - spread * line.axis.squaredNorm();
  const double variance = std::max(0.0, residuals) / (3.0 * (weights_ - parameters));
  const double length = line.axis.norm();
  line.sigma = length > 0.0 ? std::sqrt(variance / spread) / length : line.sigma;
  return line;
}

}  // namespace maploop::sensors
