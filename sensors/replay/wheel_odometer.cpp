#include "sensors/replay/wheel_odometer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sensors/replay/normal_generator.h"
#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {
namespace {

// These streams keep the numbers apart from the GNSS aid's with the same seed and stamp.
constexpr std::uint64_t own_stream = 0x7768'6565'6c00'0000;
constexpr std::uint64_t tyres_stream = 0x7479'7265'7300'0000;
constexpr std::uint64_t ice_stream = 0x6963'6500'0000'0000;

constexpr double ice_square = 50.0;  // m, a side
constexpr double ice_factor = 10.0;  // its friction is 0.1, that of asphalt 1
constexpr double max_slip = 0.5;     // 1; larger slip (a locked or spinning wheel) is cut off

}  // namespace

WheelOdometerParameters errors_of(const WheelOdometerParameters& parameters) {
  WheelOdometerParameters p = parameters;
  if (p.errors == ErrorModel::given) return p;
  NormalGenerator draw(static_cast<std::uint64_t>(p.seed) ^ tyres_stream, Time{});
  p.scale_error = draw.uniform(-0.02, 0.02);
  p.slip = draw.uniform(0.002, 0.01);
  p.ice_share = draw.uniform(0.0, 0.2);
  return p;
}

WheelOdometer::WheelOdometer(const WheelOdometerParameters& parameters)
    : parameters_(errors_of(parameters)) {
  validate_parameters(parameters);
}

// Each square of a grid of latitude and longitude either has ice or does not.
bool WheelOdometer::on_ice(const Geodetic& position) const {
  if (parameters_.ice_share <= 0.0) return false;
  constexpr double side = ice_square / 6.378e6;  // rad
  const double row = std::floor(position.latitude / side);
  const double column = std::floor(position.longitude * std::cos(row * side) / side);
  constexpr std::int64_t rows = 10'000'000;  // exceeds the number of rows
  const std::int64_t square =
      static_cast<std::int64_t>(column) * rows + static_cast<std::int64_t>(row);
  NormalGenerator draw(static_cast<std::uint64_t>(parameters_.seed) ^ ice_stream,
                       from_nanoseconds(square));
  return draw.uniform(0.0, 1.0) < parameters_.ice_share;
}

void WheelOdometer::measure(Time stamp, double speed, double force, const Geodetic& position,
                            WheelSpeed& sample) const {
  NormalGenerator generator(static_cast<std::uint64_t>(parameters_.seed) ^ own_stream, stamp);
  sample.stamp = stamp;
  double slip = parameters_.slip * force;
  if (slip != 0.0 && on_ice(position)) slip *= ice_factor;
  slip = std::clamp(slip, -max_slip, max_slip);
  sample.speed = (1.0 + parameters_.scale_error) * (1.0 + slip) * speed +
                 parameters_.white_speed * generator.next();
  sample.sigma = parameters_.white_speed;
}

}  // namespace maploop::sensors
