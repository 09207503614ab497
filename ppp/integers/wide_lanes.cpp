#include "ppp/integers/wide_lanes.h"

#include <cmath>

namespace maploop::ppp {

void WideLanes::add(const Measurement& m, double code_variance, double inflation) {
  const double f1 = m.first.frequency, f2 = m.second.frequency;
  const double length = m.wide_lane_length();
  const double cycles = m.wide_lane() / length;
  const double factor = std::hypot(f1, f2) / (f1 + f2) / length;
  Mean& mean = means_[m.satellite.slot()];
  const double weight = 1.0 / (code_variance * factor * factor * inflation);
  const double before = cycles - mean.cycles;
  mean.weight += weight;
  mean.cycles += weight / mean.weight * before;
  mean.squares += weight * before * (cycles - mean.cycles);
  mean.samples += 1.0 / inflation;
}

// (26) of METHOD.md: the assumed noise counts as much as a few samples, the measured one as much as
// there are.
double WideLanes::Mean::variance() const {
  constexpr double assumed = 2.0;
  return (assumed + squares) / (assumed + samples) / weight;
}

}  // namespace maploop::ppp
