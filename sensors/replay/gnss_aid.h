// A GNSS receiver made from a reference: thinned out, and with the noise of a receiver in a street.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "msgs/gnss.h"

namespace maploop::sensors {

struct GnssAidParameters {
  double rate = 1.0;            // Hz; of a common receiver
  double white_position = 1.0;  // m, 1 sigma an axis, independent from fix to fix
  // First-order Gauss-Markov error, 1 sigma an axis (m) and correlation time (s): multipath and
  // atmosphere, which do not average out within a turn.
  double markov_position = 1.5;
  double markov_time = 30.0;
  double white_velocity = 0.1;  // m/s, 1 sigma an axis (Doppler)
  std::int64_t seed = 1;        // another seed, another realization
};

// Position error e = w + b per east, north, up axis: w white, b Gauss-Markov of the first order,
//   b_0 ~ N(0, s^2),   b_k = a b_(k-1) + N(0, s^2 (1 - a^2)),   a = exp(-dt / markov_time)
// (Gelb, "Applied Optimal Estimation", 1974, sec. 3.8). The random numbers of a fix depend on the
// seed and its stamp alone, so the same rows give the same bits. The fix states the variances of
// this noise; the reference's own error is not in them.
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
  GnssAidParameters parameters_;
  Duration period_;
  std::optional<Time> first_;
  Time last_{};  // stamp of the last fix
  std::int64_t last_period_ = 0;
  Eigen::Vector3d markov_enu_ = Eigen::Vector3d::Zero();
};

}  // namespace maploop::sensors
