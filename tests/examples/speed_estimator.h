// This example of an estimator computes the vehicle's speed and acceleration from speeds that may
// be wrong now and then.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "msgs/parameter_archive.h"
#include "msgs/wheel_speed.h"

namespace maploop::example {

struct SpeedParameters {
  double jerk = 1.0;                // m/s^3/sqrt(Hz)
  double start_acceleration = 2.0;  // m/s^2
  double gate = 10.83;
  double max_gap = 5.0;  // s
};
// Ranges and meanings.
ParameterTable<SpeedParameters> parameter_table(const SpeedParameters&);

enum class SpeedReason : std::uint8_t { none, not_finite, not_later, gate };

struct SpeedEstimate : Sample {
  double speed = 0.0;                                        // m/s
  double acceleration = 0.0;                                 // m/s^2
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // (m/s)^2, (m/s^2)^2 on the diagonal
  SpeedReason reason = SpeedReason::none;                    // if not none, the sample was not used
};

// A SpeedEstimator is a Kalman filter with a gate for constant acceleration under white jerk
// (Bar-Shalom, Li and Kirubarajan 2001, 6.2.2).
//
// It is not thread-safe; it owns no thread, reads no clock, and allocates nothing. The same samples
// give the same bits.
class SpeedEstimator {
 public:
  // Throws std::invalid_argument naming the parameter that cannot work.
  explicit SpeedEstimator(const SpeedParameters& parameters);

  // Returns nothing before the first usable sample.
  std::optional<SpeedEstimate> add(const WheelSpeed& sample);

  // Archives everything except the parameters, which must be the same (msgs/archive.h).
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("example of an estimator", 2);
    archive_same_parameters(ar, parameters_);
    SpeedEstimator loaded = *this;  // so that a refusal changes nothing
    ar(loaded.started_, loaded.stamp_, loaded.x_, loaded.P_);
    if constexpr (Archive::loading) *this = loaded;
  }

 private:
  void predict(double seconds);
  SpeedReason correct(const WheelSpeed& sample);

  SpeedParameters parameters_;
  bool started_ = false;
  Time stamp_{};
  Eigen::Vector2d x_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d P_ = Eigen::Matrix2d::Zero();
};

}  // namespace maploop::example
