// This file simulates a GNSS receiver from a reference: at a lower rate, and with the noise of a
// receiver in a street.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "msgs/gnss.h"
#include "sensors/replay/error_model.h"

namespace maploop::sensors {

struct GnssAidParameters {
  double rate = 1.0;             // Hz
  double white_position = 1.0;   // m
  double markov_position = 1.5;  // m
  double markov_time = 30.0;     // s
  double white_velocity = 0.1;   // m/s
  ErrorModel errors = ErrorModel::given;
  std::int64_t seed = 1;
};

// These are the sizes of the errors that are actually made.
struct GnssErrors {
  double white_position, markov_position, markov_time, white_velocity;  // as above
  // In steps a reflected signal is taken for the direct one. These are their share of the time and
  // their offset, 1 sigma an axis (m). They last for 10 s on average.
  double step_share = 0.0, step_size = 10.0;
};

// Returns the sizes that the parameters state; or, if the errors are drawn, sizes that depend on
// the seed only: 0.3 to 1.5 times white_position, 0.7 to 2 times markov_position, 0.5 to 2 times
// white_velocity, markov_time within 5 to 600 s, all log-uniform, and a share of steps of 0 to 5 %.
// Positions are then off by 1.1 to 3.4 m an axis. The lower end is a data sheet's 1.5 m CEP under
// open sky (u-blox M10: 1.3 m an axis), the upper end what PPP on one frequency leaves between high
// houses (tools/simulate/FIGURES.md). The times are those of code multipath over 50 m of travel
// ([ppp] code_correlation_distance) and of reflections at an antenna at rest. Shares and sizes of
// steps are assumed.
GnssErrors errors_of(const GnssAidParameters& parameters);

// The position error is e = w + b per east, north, up axis: w white, b Gauss-Markov of the first
// order,
//   b_0 ~ N(0, s^2),   b_k = a b_(k-1) + N(0, s^2 (1 - a^2)),   a = exp(-dt / markov_time)
// (Gelb, "Applied Optimal Estimation", 1974, sec. 3.8). The random numbers of a fix depend only on
// the seed and its stamp, so the same rows give the same bits. The fix states the variances of the
// parameters, even if the errors are drawn; the reference's own error is not included.
class GnssAid {
 public:
  // Throws std::invalid_argument that names the parameter: rate not within 0.001 to 1000 Hz, a
  // sigma negative or not finite, markov_time not positive.
  explicit GnssAid(const GnssAidParameters& parameters);

  // Takes the reference at a stamp; stamps must increase. Returns true if a fix is due: at the
  // first call and at the first call at or after each further period. Then `fix` has its stamp,
  // position, velocity and covariances, and the number of the period as `sequence` (a period
  // without any call is a gap); the caller sets its other stamps.
  bool offer(Time stamp, const Geodetic& position, const Eigen::Vector3d& velocity_enu,
             GnssFix& fix);

 private:
  Eigen::Vector3d step(Time stamp);

  GnssAidParameters parameters_;
  GnssErrors errors_;
  Duration period_;
  std::optional<Time> first_;
  Time last_{};  // stamp of the last fix
  std::int64_t last_period_ = 0;
  Eigen::Vector3d markov_enu_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_enu_ = Eigen::Vector3d::Zero();
  bool in_step_ = false;
};

}  // namespace maploop::sensors
