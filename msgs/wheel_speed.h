// This file defines the forward speed from the wheels, or from a substitute.
#pragma once

#include "msgs/sample.h"

namespace maploop {

// This is the forward speed at `stamp`, with its standard deviation.
struct WheelSpeed : Sample {
  double speed = 0.0;  // m/s along the path, negative in reverse
  double sigma = 0.0;  // m/s, white; the filter estimates a scale error (tyres) itself

  void archive(auto& ar) { ar(static_cast<Sample&>(*this), speed, sigma); }
};

}  // namespace maploop
