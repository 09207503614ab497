#include "ppp/models/atmosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace maploop::ppp {
namespace {

// These are values at sea level: pressure (hPa), temperature (K), water vapour pressure (hPa), and
// the lapse rates of temperature (K/m) and vapour (1).
struct Air {
  double pressure, temperature, vapour, lapse, vapour_lapse;
};

// The rows are for 15, 30, 45, 60 and 75 degrees of latitude: the year's mean and its amplitude.
constexpr std::array<Air, 5> mean{{{1013.25, 299.65, 26.31, 6.30e-3, 2.77},
                                   {1017.25, 294.15, 21.79, 6.05e-3, 3.15},
                                   {1015.75, 283.15, 11.66, 5.58e-3, 2.57},
                                   {1011.75, 272.15, 6.78, 5.39e-3, 1.81},
                                   {1013.00, 263.65, 4.11, 4.53e-3, 1.55}}};
constexpr std::array<Air, 5> amplitude{{{0.0, 0.0, 0.0, 0.0, 0.0},
                                        {-3.75, 7.00, 8.85, 0.25e-3, 0.33},
                                        {-2.25, 11.00, 7.24, 0.32e-3, 0.46},
                                        {-1.75, 15.00, 5.36, 0.81e-3, 0.74},
                                        {-0.50, 14.50, 3.39, 0.62e-3, 0.30}}};

Air air_at(const Geodetic& site, GpsTime t) {
  const double latitude = std::abs(site.latitude) * 180.0 / std::numbers::pi;
  const double place = std::clamp(latitude / 15.0 - 1.0, 0.0, 4.0);
  const auto i = static_cast<std::size_t>(std::fmin(3.0, place));  // NaN is treated as 3
  const double share = place - static_cast<double>(i);
  const double coldest = site.latitude < 0.0 ? 211.0 : 28.0;
  const double season = std::cos(2.0 * std::numbers::pi * (day_of_year(t) - coldest) / 365.25);
  const auto value = [&](double Air::*member) {
    const auto at = [&](const std::array<Air, 5>& table) {
      return table[i].*member + share * (table[i + 1].*member - table[i].*member);
    };
    return at(mean) - at(amplitude) * season;
  };
  return {value(&Air::pressure), value(&Air::temperature), value(&Air::vapour), value(&Air::lapse),
          value(&Air::vapour_lapse)};
}

}  // namespace

double day_of_year(GpsTime t) {
  using namespace std::chrono;
  const sys_days date = floor<days>(Time(gps_epoch_day) + t.time_since_epoch());
  const sys_days new_year = year_month_day{date}.year() / 1 / 1;
  return static_cast<double>((date - new_year).count() + 1);
}

ZenithDelay zenith_delay(const Geodetic& site, GpsTime t) {
  constexpr double gas = 287.054, gravity = 9.80665, mean_gravity = 9.784;  // J/kg/K, m/s^2
  constexpr double refractivity = 382000.0;                                 // K^2/hPa
  const Air air = air_at(site, t);
  const double height = std::clamp(site.height, -500.0, 9000.0);
  const double cooler = 1.0 - air.lapse * height / air.temperature;
  const double exponent = gravity / (gas * air.lapse);
  const double pressure = air.pressure * std::pow(cooler, exponent);
  const double vapour_exponent = air.vapour_lapse + 1.0;
  const double wet_at_sea = 1e-6 * refractivity * gas /
                            (mean_gravity * vapour_exponent - air.lapse * gas) * air.vapour /
                            air.temperature;
  return {
      0.0022768 * pressure / (1.0 - 0.00266 * std::cos(2.0 * site.latitude) - 0.00028e-3 * height),
      wet_at_sea * std::pow(cooler, vapour_exponent * exponent - 1.0)};
}

}  // namespace maploop::ppp
