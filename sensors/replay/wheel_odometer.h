// This file simulates a wheel odometer from a reference: its speed with the errors of tyres and
// pulses.
#pragma once

#include <cstdint>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "msgs/wheel_speed.h"
#include "sensors/replay/error_model.h"

namespace maploop::sensors {

struct WheelOdometerParameters {
  double scale_error = 0.0;
  double white_speed = 0.05;  // m/s
  double slip = 0.0;          // s^2/m
  double ice_share = 0.0;
  ErrorModel errors = ErrorModel::given;
  std::int64_t seed = 1;
};

// Returns the parameters as they are; or, if the errors are drawn, values that the seed draws:
// scale_error within +-2 %, the effect of tread wear on a tyre's radius of 0.31 m; slip within
// 0.002 to 0.01 s^2/m, as force by load is 20 to 40 times the slip on asphalt (Gustafsson,
// "Slip-based tire-road friction estimation", Automatica 33(6), 1997) and the wheels that drive or
// brake carry half of the load to all of it; ice_share within 0 to 0.2, assumed.
WheelOdometerParameters errors_of(const WheelOdometerParameters& parameters);

class WheelOdometer {
 public:
  // Throws std::invalid_argument that names the parameter that is out of its range.
  explicit WheelOdometer(const WheelOdometerParameters& parameters);

  // Sets stamp, speed (m/s) and sigma. The noise depends only on the seed and the stamp, ice on the
  // seed and the place. `force` is the specific force forward, m/s^2.
  void measure(Time stamp, double speed, double force, const Geodetic& position,
               WheelSpeed& sample) const;

 private:
  bool on_ice(const Geodetic& position) const;

  WheelOdometerParameters parameters_;
};

}  // namespace maploop::sensors
