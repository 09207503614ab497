#include "tools/simulate/sensors/imu_errors.h"

#include <cmath>
#include <cstddef>

#include "msgs/frames.h"

namespace maploop::simulate {
namespace {

constexpr std::array<double, 3> correlation_times{10.0, 100.0, 1000.0};  // s
constexpr double milli_g = 9.80665e-3;                                   // m/s^2

constexpr double degrees_per_hour(double value) {
  return radians(value) / 3600.0;
}

}  // namespace

ImuParameters imu_parameters(ImuGrade grade) {
  const double root_hour = radians(1.0) / 60.0;  // deg/sqrt(h) in rad/sqrt(s)
  if (grade == ImuGrade::tactical)
    return {{degrees_per_hour(2.0), degrees_per_hour(2.0), 0.2 * root_hour, 5e-4, 2e-4},
            {1.0 * milli_g, 0.05 * milli_g, 1e-3, 5e-4, 2e-4}};
  return {{degrees_per_hour(300.0), degrees_per_hour(10.0), 0.3 * root_hour, 2e-3, 2e-3},
          {20.0 * milli_g, 0.2 * milli_g, 2e-3, 2e-3, 2e-3}};
}

TriadErrors::TriadErrors(const TriadParameters& parameters, double interval, std::uint64_t seed,
                         std::uint64_t stream)
    : parameters_(parameters),
      interval_(interval),
      random_(seed, from_nanoseconds(static_cast<std::int64_t>(stream))) {
  turn_on_ = parameters_.turn_on * normal();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      shape_(row, column) = row == column ? 1.0 + parameters_.scale * random_.next()
                                          : parameters_.misalignment * random_.next();
  for (Eigen::Vector3d& process : flicker_)
    process = parameters_.instability / std::sqrt(3.0) * normal();
}

Eigen::Vector3d TriadErrors::normal() {
  const double x = random_.next(), y = random_.next();
  return {x, y, random_.next()};
}

Eigen::Vector3d TriadErrors::measure(const Eigen::Vector3d& truth) {
  Eigen::Vector3d measured = shape_ * truth + turn_on_;
  for (std::size_t i = 0; i < flicker_.size(); ++i) {
    const double keep = std::exp(-interval_ / correlation_times[i]);
    flicker_[i] = keep * flicker_[i] +
                  parameters_.instability * std::sqrt((1.0 - keep * keep) / 3.0) * normal();
    measured += flicker_[i];
  }
  return measured + parameters_.white / std::sqrt(interval_) * normal();
}

}  // namespace maploop::simulate
