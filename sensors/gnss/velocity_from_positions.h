// This file finds the velocity of a receiver that states positions only.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "msgs/gnss.h"

namespace maploop::sensors {

// Takes the derivative of the parabola through a fix and those a second and two before.
class VelocityFromPositions {
 public:
  // Sets the velocity of the fix; its standard deviation is 100 m/s until it can be found. Fixes
  // come in the order of time.
  void set_velocity(GnssFix& fix);

  static void set_unknown(GnssFix& fix);

 private:
  struct EarlierFix {
    Time stamp{};
    Geodetic position;
  };
  std::deque<EarlierFix> earlier_;  // the last one first
};

}  // namespace maploop::sensors
