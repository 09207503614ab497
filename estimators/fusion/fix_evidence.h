// Consecutive fixes that agree with each other are evidence against another aid.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "msgs/gnss.h"
#include "msgs/local_frame.h"

namespace maploop::fusion {

// Return the greatest standard deviation of a horizontal axis, m/s and m.
inline double velocity_sigma_of(const GnssFix& fix) {
  return std::sqrt(fix.velocity_covariance.diagonal().head<2>().maxCoeff());
}
inline double position_sigma_of(const GnssFix& fix) {
  return std::sqrt(fix.position_covariance.diagonal().head<2>().maxCoeff());
}

// A step leads from one fix to the next.
struct FixStep {
  double interval = 0.0;        // s; 0: the fix says nothing together with the one before
  double way = 0.0;             // m, by the velocities
  Eigen::Vector2d apart{0, 0};  // m, enu, by which the positions moved otherwise than that
};

// The steps that contradict an aid, without a break.
struct FixEvidence {
  double seconds = 0.0;
  double way = 0.0;             // m
  Eigen::Vector2d apart{0, 0};  // m
  int steps = 0;

  void add(const FixStep& step) {
    seconds += step.interval;
    way += step.way;
    apart += step.apart;
    ++steps;
  }
  // Returns whether it lasts for `least` s, and the positions, of this standard deviation (m),
  // moved as the velocities say: else the fixes contradict themselves.
  bool shows(double least, double sigma) const {
    constexpr int least_steps = 3;
    constexpr double sigmas = 4.0, share = 0.25;  // the share is that of the way
    return steps >= least_steps && seconds >= least && apart.norm() <= sigmas * sigma + share * way;
  }
};

template <class Archive>
void archive(Archive& ar, FixEvidence& e) {
  ar(e.seconds, e.way, e.apart, e.steps);
}

// The newest fix with a velocity.
struct FixBefore {
  Time stamp{};
  Eigen::Vector2d place{0, 0};     // m, enu
  Eigen::Vector2d velocity{0, 0};  // m/s
  bool repeats = false;            // a moving one before it, bit for bit: the receiver is stuck

  // Returns the step to a fix, and keeps the fix. A receiver that is stuck, or was silent for long,
  // says nothing.
  FixStep step_to(const GnssFix& fix, const LocalFrame& frame) {
    constexpr double longest = 2.5;  // s
    constexpr double moving = 1.0;   // m/s
    const FixBefore before = *this;
    stamp = fix.velocity_stamp;
    place = frame.to_enu(fix.position).head<2>();
    velocity = fix.velocity_enu.head<2>();
    repeats = place == before.place && velocity == before.velocity && velocity.norm() > moving;
    const double interval = to_seconds(stamp - before.stamp);
    if (!(interval > 0.0) || interval > longest || repeats) return {};
    const Eigen::Vector2d moved = 0.5 * interval * (before.velocity + velocity);
    return {interval, moved.norm(), place - before.place - moved};
  }
};

template <class Archive>
void archive(Archive& ar, FixBefore& f) {
  ar(f.stamp, f.place, f.velocity, f.repeats);
}

}  // namespace maploop::fusion
