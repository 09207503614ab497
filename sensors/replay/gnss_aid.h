// A GNSS receiver made from a reference: thinned out, and with the noise of a receiver in a street.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "msgs/gnss.h"
#include "sensors/replay/error_model.h"

namespace maploop::sensors {

struct GnssAidParameters {
  double rate = 1.0;            // Hz; of a common receiver
  double white_position = 1.0;  // m, 1 sigma an axis, independent from fix to fix
  // First-order Gauss-Markov error, 1 sigma an axis (m) and correlation time (s): multipath and
  // atmosphere, which do not average out within a turn.
  double markov_position = 1.5;
  double markov_time = 30.0;
  double white_velocity = 0.1;  // m/s, 1 sigma an axis (Doppler)
  ErrorModel errors = ErrorModel::given;
  std::int64_t seed = 1;  // another seed, another realization
};

// Sizes of the errors really made.
struct GnssErrors {
  double white_position, markov_position, markov_time, white_velocity;  // as above
  // Stretches in which a reflected signal is taken for the straight one: share of the time, and
  // their offset, 1 sigma an axis (m). They last for 10 s in the mean.
  double step_share = 0.0, step_size = 10.0;
};

// As the parameters say; or, where the errors are drawn, of the seed alone: 0.3 to 1.5 of
// white_position, 0.7 to 2 of markov_position, 0.5 to 2 of white_velocity, markov_time within 5 to
// 600 s, each ratio as likely, and a share of steps of 0 to 5 %. Positions are then off by 1.1 to
// 3.4 m an axis: the least is a data sheet's 1.5 m CEP under open sky (u-blox M10: 1.3 m an axis),
// the most what PPP on one frequency leaves between high houses (tools/simulate/README.md). The
// times are those of multipath of code on 50 m of way, and of reflections ([ppp]
// code_correlation_distance, reflection_time). Shares and sizes of steps are assumed.
GnssErrors errors_of(const GnssAidParameters& parameters);

// Position error e = w + b per east, north, up axis: w white, b Gauss-Markov of the first order,
//   b_0 ~ N(0, s^2),   b_k = a b_(k-1) + N(0, s^2 (1 - a^2)),   a = exp(-dt / markov_time)
// (Gelb, "Applied Optimal Estimation", 1974, sec. 3.8). The random numbers of a fix depend on the
// seed and its stamp alone, so the same rows give the same bits. The fix states the variances of
// the parameters, also where the errors are drawn; the reference's own error is not in them.
class GnssAid {
 public:
  // Throws std::invalid_argument naming the parameter: rate not within 0.001 to 1000 Hz, a sigma
  // negative or not finite, markov_time not positive.
  explicit GnssAid(const GnssAidParameters& parameters);

  // Offers the reference at a stamp; stamps increase. True where a fix is due: at the first offer
  // and at the first one at or after each further period. Then `fix` has its stamp, position,
  // velocity, covariances, and the number of the period as `sequence` (a period without any offer
  // is a gap); its other stamps are the caller's.
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
