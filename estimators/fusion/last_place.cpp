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
constexpr Duration longest_standing = std::chrono::hours(24 * 365);
// Samples are delivered later than they are stamped, and clocks of one machine differ by less.
constexpr Duration most_ahead = std::chrono::seconds(1);
// Beyond these the filter is not linear, or a fix says more.
constexpr double most_horizontal_sigma = 50.0;  // m
constexpr double most_azimuth_sigma = 0.5;      // rad

double days(Duration age) {
  return to_seconds(age) / 86400.0;
}

}  // namespace

LastPlace last_place(const NavState& s) {
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, s.covariance(i, i))); };
  LastPlace place;
  place.stamp = s.stamp;
  place.position = LocalFrame(s.origin).to_geodetic(s.position_enu);
  place.attitude = s.attitude;
  place.speed = s.forward_speed;
  place.horizontal_sigma = std::max(sigma(0), sigma(1));
  place.up_sigma = sigma(2);
  const Eigen::Vector3d travel = s.velocity_enu.normalized();
  place.speed_sigma = std::sqrt(std::max(0.0, travel.dot(s.covariance.block<3, 3>(3, 3) * travel)));
  place.azimuth_sigma = sigma(6);
  place.tilt_sigma = std::max(sigma(7), sigma(8));
  return place;
}

PlaceStart start_at(const LastPlace& place, Time first, const FusionParameters& parameters) {
  if (!plausible_stamp(place.stamp) || !plausible_stamp(first)) return {PlaceUse::too_old, {}};
  if (first < place.stamp - most_ahead) return {PlaceUse::from_future, {}};
  const Duration age = std::max(first - place.stamp, Duration::zero());
  const bool stands = std::abs(place.speed) < standing_speed;
  if (age > (stands ? longest_standing : from_seconds(parameters.max_gap)))
    return {PlaceUse::too_old, {}};
  if (!(place.horizontal_sigma <= most_horizontal_sigma &&
        place.azimuth_sigma <= most_azimuth_sigma)) {
    return {PlaceUse::too_uncertain, {}};
  }
  KnownStart k;
  k.stamp = place.stamp;
  k.position = place.position;
  k.attitude = place.attitude;
  k.speed = place.speed;
  k.position_sigma = place.horizontal_sigma;
  k.up_sigma = place.up_sigma;
  k.azimuth_sigma = place.azimuth_sigma;
  k.tilt_sigma = place.tilt_sigma;
  k.speed_sigma = place.speed_sigma;
  if (stands) {
    const double growth = 1.0 + std::sqrt(days(age));
    k.stamp += age;
    k.speed = 0.0;
    k.position_sigma = std::hypot(place.horizontal_sigma, settled_place * growth);
    k.up_sigma = std::hypot(place.up_sigma, settled_place * growth);
    k.azimuth_sigma = std::hypot(place.azimuth_sigma, settled_azimuth * growth);
    k.tilt_sigma = std::hypot(place.tilt_sigma, settled_tilt);
    k.speed_sigma = standing_speed_sigma;
  }
  return check_start(k) == Reason::none ? PlaceStart{PlaceUse::started, k}
                                        : PlaceStart{PlaceUse::too_uncertain, {}};
}

}  // namespace maploop::fusion
