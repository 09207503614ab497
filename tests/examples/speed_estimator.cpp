#include "tests/examples/speed_estimator.h"

#include <cmath>

namespace maploop::example {

ParameterTable<SpeedParameters> parameter_table(const SpeedParameters&) {
  using enum Audience;
  using P = SpeedParameters;
  constexpr double most = 1e6;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"jerk", &P::jerk, above_zero, most, "m/s^3/sqrt(Hz)", expert,
       "White jerk of the vehicle: braking and accelerating."},
      {"start_acceleration", &P::start_acceleration, above_zero, most, "m/s^2", expert,
       "Standard deviation of the acceleration at the start."},
      {"gate", &P::gate, above_zero, most, "1", expert,
       "Gate of a speed (chi-square, 1 degree of freedom); the default has a tail of 0.1 %."},
      {"max_gap", &P::max_gap, above_zero, most, "s", expert,
       "Time without samples after which the estimator starts again."},
  });
  return {"speed", "An estimator of the speed.", table};
}

SpeedEstimator::SpeedEstimator(const SpeedParameters& parameters) : parameters_(parameters) {
  validate_parameters(parameters_);
}

std::optional<SpeedEstimate> SpeedEstimator::add(const WheelSpeed& sample) {
  SpeedReason reason = SpeedReason::none;
  const double seconds = started_ ? to_seconds(sample.stamp - stamp_) : 0.0;
  if (!std::isfinite(sample.speed) || !(sample.sigma > 0.0 && std::isfinite(sample.sigma))) {
    reason = SpeedReason::not_finite;
  } else if (started_ && seconds <= 0.0) {
    reason = SpeedReason::not_later;
  } else if (!started_ || seconds > parameters_.max_gap) {
    started_ = true;
    stamp_ = sample.stamp;
    x_ << sample.speed, 0.0;
    P_ = Eigen::Vector2d(sample.sigma * sample.sigma, std::pow(parameters_.start_acceleration, 2))
             .asDiagonal();
  } else {
    predict(seconds);
    stamp_ = sample.stamp;
    reason = correct(sample);
  }
  if (!started_) return std::nullopt;
  SpeedEstimate estimate;
  static_cast<Sample&>(estimate) = sample;
  estimate.stamp = stamp_;
  estimate.speed = x_[0];
  estimate.acceleration = x_[1];
  estimate.covariance = P_;
  estimate.reason = reason;
  return estimate;
}

void SpeedEstimator::predict(double t) {
  Eigen::Matrix2d F, Q;
  F << 1.0, t, 0.0, 1.0;
  Q << t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t;
  x_ = F * x_;
  P_ = F * P_ * F.transpose() + parameters_.jerk * parameters_.jerk * Q;
}

SpeedReason SpeedEstimator::correct(const WheelSpeed& sample) {
  const double residual = sample.speed - x_[0];
  const double variance = P_(0, 0) + sample.sigma * sample.sigma;
  if (residual * residual > parameters_.gate * variance) return SpeedReason::gate;
  const Eigen::Vector2d gain = P_.col(0) / variance;
  x_ += gain * residual;
  P_ -= gain * gain.transpose() * variance;
  return SpeedReason::none;
}

}  // namespace maploop::example
