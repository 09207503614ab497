#include "estimators/fusion/last_place.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimators/fusion/stamp_guard.h"

namespace maploop::fusion {
namespace {

// These are assumptions about cars, and no measurements.
constexpr double standing_speed = 0.5;  // m/s: a car that creeps so is caught by its first fix
// A car that was left settles, is loaded, rolls against its gear; the longer it is away, the more.
constexpr double settled_place = 0.5;         // m at once, as much again after a day
constexpr double settled_azimuth = 0.0175;    // rad (1 deg), the same
constexpr double settled_tilt = 0.0087;       // rad (0.5 deg): load
constexpr double standing_speed_sigma = 0.1;  // m/s
// A run that ended within this time may have ended in the middle of a drive, at a traffic light:
// the car may have driven off since.
constexpr Duration interrupted = std::chrono::seconds(60);
constexpr double drives_off = 1.0;                       // m/s^2
constexpr double most_driven = 40.0, most_speed = 10.0;  // m, m/s
constexpr double slope = 0.05;                           // of the road
constexpr Duration longest_standing = std::chrono::hours(24 * 365);
// Samples are delivered later than they are stamped, and clocks of one machine differ by less.
constexpr Duration most_ahead = std::chrono::seconds(1);
// Beyond these the filter is not linear, or a fix says more.
constexpr double most_horizontal_sigma = 50.0;  // m
constexpr double most_azimuth_sigma = 0.5;      // rad

double days(Duration age) {
  return to_seconds(age) / 86400.0;
}

// Grows the uncertainty of a vehicle that has stood for so long.
void stand(KnownStart& k, Duration age, const FusionParameters& p) {
  const double growth = 1.0 + std::sqrt(days(age));
  // (8) of METHOD.md
  const double kept = std::exp(-to_seconds(age) / p.gnss_offset_time);
  k.stamp += age;
  const double t = age < interrupted ? to_seconds(age) : 0.0;
  const double driven = std::min(0.5 * drives_off * t * t, most_driven);
  k.speed = 0.0;
  k.speed_sigma = std::hypot(standing_speed_sigma, std::min(drives_off * t, most_speed));
  for (int i = 0; i < 3; ++i) {
    const double sigma = std::hypot(k.position_sigma[i], settled_place * growth,
                                    i == index::up ? slope * driven : driven);
    const double offset = kept * k.fix_offset_sigma[i];
    const double now = std::sqrt(offset * offset + 1.0 - kept * kept);
    if (now > 0.0) k.fix_offset_correlation[i] *= k.position_sigma[i] / sigma * offset / now;
    k.position_sigma[i] = sigma;
    k.fix_offset[i] *= kept;
    k.fix_offset_sigma[i] = now;
  }
  k.azimuth_sigma = std::hypot(k.azimuth_sigma, settled_azimuth * growth);
  k.tilt_sigma = std::hypot(k.tilt_sigma, settled_tilt);
}

}  // namespace

LastPlace last_place(const FilterState& state, const LocalFrame& frame) {
  using namespace index;
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, state.P(i, i))); };
  LastPlace place;
  place.stamp = state.stamp;
  place.position = frame.to_geodetic(state.x.segment<3>(east));
  place.attitude = state.attitude();
  place.speed = state.ground_speed();
  // Of V / (1 + s).
  const double scaled = state.P(speed, speed) - 2.0 * place.speed * state.P(speed, speed_scale) +
                        place.speed * place.speed * state.P(speed_scale, speed_scale);
  place.speed_sigma = std::sqrt(std::max(0.0, scaled)) / std::abs(1.0 + state.x[speed_scale]);
  place.azimuth_sigma = sigma(azimuth);
  place.tilt_sigma = std::max(sigma(pitch), sigma(roll));
  for (int i = east; i <= up; ++i) {
    const int offset = gnss_offset_east + i;
    place.position_sigma[i] = sigma(i);
    place.fix_offset[i] = state.x[offset];
    place.fix_offset_sigma[i] = sigma(offset);
    const double product = sigma(i) * sigma(offset);
    if (product > 0.0)
      place.fix_offset_correlation[i] = std::clamp(state.P(i, offset) / product, -1.0, 1.0);
  }
  return place;
}

KnownStart known_start(const LastPlace& place) {
  return {place.stamp,
          place.position,
          place.attitude,
          place.speed,
          place.position_sigma,
          place.azimuth_sigma,
          place.tilt_sigma,
          place.speed_sigma,
          place.fix_offset,
          place.fix_offset_sigma,
          place.fix_offset_correlation};
}

PlaceStart start_at(const LastPlace& place, Time first, const FusionParameters& parameters) {
  if (!plausible_stamp(place.stamp) || !plausible_stamp(first)) return {PlaceUse::too_old, {}};
  if (first < place.stamp - most_ahead) return {PlaceUse::from_future, {}};
  const Duration age = std::max(first - place.stamp, Duration::zero());
  const bool stands = std::abs(place.speed) < standing_speed;
  if (age > (stands ? longest_standing : from_seconds(parameters.max_gap)))
    return {PlaceUse::too_old, {}};
  if (!(place.position_sigma.head<2>().maxCoeff() <= most_horizontal_sigma &&
        place.azimuth_sigma <= most_azimuth_sigma)) {
    return {PlaceUse::too_uncertain, {}};
  }
  KnownStart k = known_start(place);
  if (stands) stand(k, age, parameters);
  return check_start(k) == Reason::none ? PlaceStart{PlaceUse::started, k}
                                        : PlaceStart{PlaceUse::too_uncertain, {}};
}

}  // namespace maploop::fusion
