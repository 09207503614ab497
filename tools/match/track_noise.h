// Errors of a receiver in a street, added to a recorded track.
#pragma once

#include <cstdint>

#include "tools/match/track.h"

namespace maploop::match {

struct TrackNoise {
  double white = 0.0;         // m an axis, independent from fix to fix
  double markov = 0.0;        // m an axis, first-order Gauss-Markov
  double markov_time = 30.0;  // s
  double speed = 0.0;         // m/s
  double azimuth = 0.0;       // rad
  std::uint64_t seed = 1;
};

// The first row of each second that has one (`interval` > 0), with errors and their covariance
// added. `rows` gets the number of each fix's row, where it is not null.
Track with_noise(const Track& track, double interval, const TrackNoise& noise,
                 std::vector<std::size_t>* rows = nullptr);

}  // namespace maploop::match
