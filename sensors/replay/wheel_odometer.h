// A wheel odometer made from a reference: its speed with the errors of tyres and pulses.
#pragma once

#include <cstdint>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "msgs/wheel_speed.h"
#include "sensors/replay/error_model.h"

namespace maploop::sensors {

struct WheelOdometerParameters {
  double scale_error = 0.0;   // 1, what it reads too much: worn or soft tyres make 1 %
  double white_speed = 0.05;  // m/s, 1 sigma, independent from sample to sample: counting pulses
  // s^2/m, share of the speed that wheels turn too fast for each m/s^2 of the force that drives the
  // car, uphill too, and too slowly where it brakes.
  double slip = 0.0;
  double ice_share = 0.0;  // 1, of the road, in squares of 50 m, where they slip ten times as much
  ErrorModel errors = ErrorModel::given;
  std::int64_t seed = 1;  // another seed, another realization
};

// As they are; or, where the errors are drawn, of the seed: scale_error within +-2 %, which a
// tyre's tread makes of a radius of 0.31 m while it wears off; slip within 0.002 to 0.01 s^2/m, as
// force by load is 20 to 40 times the slip on asphalt (Gustafsson, "Slip-based tire-road friction
// estimation", Automatica 33(6), 1997) and half of the load to all of it is on the wheels that
// drive or brake; ice_share within 0 to 0.2, assumed.
WheelOdometerParameters errors_of(const WheelOdometerParameters& parameters);

class WheelOdometer {
 public:
  // Throws std::invalid_argument naming the parameter: scale_error beyond +-0.5, white_speed
  // negative, slip not within 0 to 0.1, ice_share not within 0 to 1, or not finite.
  explicit WheelOdometer(const WheelOdometerParameters& parameters);

  // Speed and sigma; noise depends on the seed and the stamp alone, ice on the seed and the place.
  // `force` is the specific force forward, m/s^2.
  void measure(Time stamp, double speed, double force, const Geodetic& position,
               WheelSpeed& sample) const;

 private:
  bool on_ice(const Geodetic& position) const;

  WheelOdometerParameters parameters_;
};

}  // namespace maploop::sensors
