// Adds the errors of a receiver in a street to a recorded track.
#pragma once

#include <cstdint>

#include "tools/match/track.h"

namespace maploop::match {

struct TrackNoise {
  double white = 0.0;         // m on each axis, independent from fix to fix
  double markov = 0.0;        // m on each axis, first-order Gauss-Markov
  double markov_time = 30.0;  // s
  double speed = 0.0;         // m/s
  double azimuth = 0.0;       // rad
  std::uint64_t seed = 1;
};

// Returns the first row of each period of `interval` seconds that has one (0: all rows), with
// errors added to the values and their variances to the covariance. If `rows` is not null, it gets
// the row number of each fix.
Track with_noise(const Track& track, double interval, const TrackNoise& noise,
                 std::vector<std::size_t>* rows = nullptr);

}  // namespace maploop::match
