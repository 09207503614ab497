// Forward speed from the wheels, or from what stands for them.
#pragma once

#include "msgs/sample.h"

namespace maploop {

struct WheelSpeed : Sample {
  double speed = 0.0;  // m/s along the way, negative in reverse
  double sigma = 0.0;  // m/s, white; a scale error (tyres) is the filter's to find
};

template <class Archive>
void archive(Archive& ar, WheelSpeed& s) {
  ar(static_cast<Sample&>(s), s.speed, s.sigma);
}

}  // namespace maploop
