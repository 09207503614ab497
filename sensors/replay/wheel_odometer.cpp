#include "sensors/replay/wheel_odometer.h"

#include <cmath>
#include <stdexcept>

#include "sensors/replay/normal_generator.h"

namespace maploop::sensors {
namespace {

// Its numbers are not those of the GNSS aid with the same seed and stamp.
constexpr std::uint64_t own_stream = 0x7768'6565'6c00'0000;

}  // namespace

WheelOdometer::WheelOdometer(const WheelOdometerParameters& parameters) : parameters_(parameters) {
  if (!(std::abs(parameters.scale_error) <= 0.5)) {
    throw std::invalid_argument("wheel odometer: scale_error must be within -0.5 to 0.5");
  }
  if (!(parameters.white_speed >= 0.0 && std::isfinite(parameters.white_speed))) {
    throw std::invalid_argument("wheel odometer: white_speed must be 0 or more");
  }
}

void WheelOdometer::measure(Time stamp, double speed, WheelSpeed& sample) const {
  NormalGenerator generator(static_cast<std::uint64_t>(parameters_.seed) ^ own_stream, stamp);
  sample.stamp = stamp;
  sample.speed =
      (1.0 + parameters_.scale_error) * speed + parameters_.white_speed * generator.next();
  sample.sigma = parameters_.white_speed;
}

}  // namespace maploop::sensors
