// A wheel odometer made from a reference: its speed with the errors of tyres and pulses.
#pragma once

#include <cstdint>

#include "msgs/time.h"
#include "msgs/wheel_speed.h"

namespace maploop::sensors {

struct WheelOdometerParameters {
  double scale_error = 0.0;   // 1, what it reads too much: worn or soft tyres make 1 %
  double white_speed = 0.05;  // m/s, 1 sigma, independent from sample to sample: counting pulses
  std::int64_t seed = 1;      // another seed, another realization
};

class WheelOdometer {
 public:
  // Throws std::invalid_argument naming the parameter: scale_error beyond +-0.5, white_speed
  // negative, or not finite.
  explicit WheelOdometer(const WheelOdometerParameters& parameters);

  // Speed and sigma; depends on the seed and the stamp alone.
  void measure(Time stamp, double speed, WheelSpeed& sample) const;

 private:
  WheelOdometerParameters parameters_;
};

}  // namespace maploop::sensors
