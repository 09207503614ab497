// The velocities of fixes show whether the wheels measure the vehicle's speed.
//
// The wheels come a hundred times as often as fixes, so a filter that is given a speed in another
// unit follows it, and on a ferry it stands still. Each gate judges by the state, which the wheels
// have moved; this compares the two sensors with each other.
#pragma once

#include "estimators/fusion/fix_evidence.h"
#include "msgs/wheel_speed.h"

namespace maploop::fusion {

// This is what the fixes have shown of the wheels so far.
struct WheelCheck {
  double speed = 0.0;   // m/s, of the newest sample
  Time stamp{};         // of the same
  FixEvidence opposed;  // of fixes that contradict `wrong`
  bool wrong = false;   // the wheels do not measure the speed

  void add(const WheelSpeed& sample) {
    speed = sample.speed;
    stamp = sample.stamp;
  }
  // Compares the newest sample with the velocity of a fix. `scale` is how much more than the speed
  // over ground the wheels read, 1. Returns whether `wrong` has become true.
  bool compare(const GnssFix& fix, const FixStep& step, double scale);
};

template <class Archive>
void archive(Archive& ar, WheelCheck& w) {
  ar(w.speed, w.stamp, w.opposed, w.wrong);
}

// Road vehicles do not drive faster in reverse.
inline constexpr double fastest_reverse = 6.0;  // m/s

}  // namespace maploop::fusion
