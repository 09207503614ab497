// Lasting contradictions between an aid and everything else that the filter knows.
//
// A gate judges one innovation, so an error that grows slowly, or that is small at each sample,
// passes it and moves the state. Such an error gives innovations whose mean over seconds is not
// zero: that is for HEALTH. Errors that scatter by more than their sensor says pass it often: such
// a sensor loses weight, too.
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

// Mean and scatter of innovations over the last seconds, in units of their own standard deviation.
struct LastingError {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0;   // sum of the squared lengths
  double count = 0.0;     // of innovations, each by its weight
  double variance = 0.0;  // of each component of the sum
  Time stamp{};

  // `whitened` has the components that the aid has; a missing one is 0. A single outlier counts as
  // four standard deviations at most: outliers are the gate's.
  void add(Eigen::Vector2d whitened, Time t, double memory) {
    constexpr double most = 4.0;
    const double length = whitened.norm();
    if (length > most) whitened *= most / length;
    const double kept = count > 0.0 ? std::exp(-to_seconds(t - stamp) / memory) : 0.0;
    sum = kept * sum + whitened;  // (37) of METHOD.md
    variance = kept * kept * variance + 1.0;
    squares = kept * squares + whitened.squaredNorm();
    count = kept * count + 1.0;
    stamp = t;
  }
  // Chi-square distributed, with a degree of freedom for each component, if the innovations are
  // white.
  double mean() const { return variance > 0.0 ? sum.squaredNorm() / variance : 0.0; }
  // The mean of the squared lengths: 1 for each component if the covariance is right. 0 before
  // there are a few.
  double scatter() const { return count > 4.0 ? squares / count : 0.0; }
  // How many times too small the covariance of innovations of so many components is; 1 if it is not
  // too small by more than `most`.
  double excess(int components, double most) const {
    const double times = scatter() / components;
    return times > most ? times : 1.0;
  }
};

template <class Archive>
void archive(Archive& ar, LastingError& e) {
  ar(e.sum, e.squares, e.count, e.variance, e.stamp);
}

struct Contradictions {
  std::array<LastingError, static_cast<std::size_t>(Witness::count)> errors;

  LastingError& of(Witness w) { return errors[static_cast<std::size_t>(w)]; }
  const LastingError& of(Witness w) const { return errors[static_cast<std::size_t>(w)]; }
};

template <class Archive>
void archive(Archive& ar, Contradictions& c) {
  ar(c.errors);
}

}  // namespace maploop::fusion
