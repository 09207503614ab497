// Lasting contradictions between an aid and everything else that the filter knows.
//
// A gate judges one innovation, so an error that grows slowly, or that is small at each sample,
// passes it and moves the state. Such an error gives innovations whose mean over seconds is not
// zero. These statistics decide nothing in the filter: they are for HEALTH.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "msgs/time.h"

namespace maploop::fusion {

// Which innovations are followed.
enum class Witness : std::uint8_t {
  fix_position,   // of a fix, east and north
  fix_velocity,   // the same
  motion_length,  // of odometry, along the way
  motion_turn,    // of odometry, about the vertical: against the gyro
  wheel_speed,
  count
};

// The mean over the last seconds of innovations in units of their own standard deviation.
struct LastingMean {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  Time stamp{};

  // `whitened` has the components that the aid has; a missing one is 0. A single outlier counts as
  // four standard deviations at most: outliers are the gate's.
  void add(Eigen::Vector2d whitened, Time t, double memory) {
    constexpr double most = 4.0;
    const double length = whitened.norm();
    if (length > most) whitened *= most / length;
    const double kept = weight > 0.0 ? std::exp(-to_seconds(t - stamp) / memory) : 0.0;
    sum = kept * sum + whitened;  // (37) of METHOD.md
    weight = kept * kept * weight + 1.0;
    stamp = t;
  }
  // Chi-square distributed, with a degree of freedom for each component, if the aid agrees.
  double statistic() const { return weight > 0.0 ? sum.squaredNorm() / weight : 0.0; }
};

template <class Archive>
void archive(Archive& ar, LastingMean& m) {
  ar(m.sum, m.weight, m.stamp);
}

struct Contradictions {
  std::array<LastingMean, static_cast<std::size_t>(Witness::count)> means;

  LastingMean& of(Witness w) { return means[static_cast<std::size_t>(w)]; }
  const LastingMean& of(Witness w) const { return means[static_cast<std::size_t>(w)]; }
};

template <class Archive>
void archive(Archive& ar, Contradictions& c) {
  ar(c.means);
}

}  // namespace maploop::fusion
