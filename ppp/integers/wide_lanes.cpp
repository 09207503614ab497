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

// The receiver's bias is that of the most precise satellite, improved by those that agree with it.
void WideLanes::resolve(std::span<IntegerCandidate> of_one_system, double largest_sigma,
                        double largest_fraction) const {
  const auto mean = [this](const IntegerCandidate& c) { return means_[c.satellite.slot()]; };
  Mean best;
  for (const IntegerCandidate& c : of_one_system) {
    if (mean(c).weight > best.weight) best = mean(c);
  }
  double sum = 0.0, weights = 0.0;
  for (const IntegerCandidate& c : of_one_system) {
    const double fraction = std::remainder(mean(c).cycles - best.cycles, 1.0);
    if (std::abs(fraction) > largest_fraction) continue;
    sum += mean(c).weight * fraction;
    weights += mean(c).weight;
  }
  const double bias = best.cycles + (weights > 0.0 ? sum / weights : 0.0);
  for (IntegerCandidate& c : of_one_system) {
    const double off = mean(c).cycles - bias;
    c.wide_lane = std::round(off);
    c.resolved = mean(c).weight > 0.0 && mean(c).variance() <= largest_sigma * largest_sigma &&
                 std::abs(off - c.wide_lane) <= largest_fraction;
  }
}

}  // namespace maploop::ppp
