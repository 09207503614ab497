// A slowly changing error, like those of orbits and clocks.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulate/random.h"

namespace maploop::simulate {

// The sum of two waves with periods of 3 to 14 hours; `sigma` is its root mean square over time.
class SlowError {
 public:
  SlowError(double sigma, Random& random) {
    for (Wave& wave : waves_)
      wave = {2.0 * std::numbers::pi / (3600.0 * random.uniform(3.0, 14.0)),
              random.uniform(0.0, 2.0 * std::numbers::pi), sigma};
  }

  double at(double t) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += wave.size * std::sin(wave.number * t + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    double number, phase, size;  // rad/s, rad
  };
  std::array<Wave, 2> waves_;
};

}  // namespace maploop::simulate
