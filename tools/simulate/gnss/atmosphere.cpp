#include "tools/simulate/gnss/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using std::numbers::pi;
constexpr double earth_radius = 6'371'000.0;  // m
constexpr double air_top = 80'000.0;          // m
constexpr int layers = 400;

struct Weather {
  double pressure, temperature, vapour;  // hPa, K, hPa at the sea
};

struct Refractivity {
  double dry, wet;  // 1e-6
};

// Temperature falls by 6.5 K/km up to 11 km; the density of vapour has a scale height of 2.2 km.
// The coefficients are those of Thayer (1974), rounded.
Refractivity refractivity(const Weather& w, double height) {
  constexpr double lapse = 6.5e-3, tropopause = 11'000.0, exponent = 5.2561;
  const double h = std::min(height, tropopause);
  const double temperature = w.temperature - lapse * h;
  double pressure = w.pressure * std::pow(temperature / w.temperature, exponent);
  if (height > tropopause)
    pressure *= std::exp(-(height - tropopause) * 9.80665 / (287.05 * temperature));
  const double vapour = w.vapour * std::exp(-height / 2200.0);
  return {77.6 * pressure / temperature, 3.75e5 * vapour / (temperature * temperature)};
}

}  // namespace

Troposphere::Troposphere(double height, std::uint64_t seed) {
  Random random(seed, 22);
  const Weather weather{1013.25 + 8.0 * random.normal(), 287.0 + 5.0 * random.normal(),
                        std::max(2.0, 9.5 + 2.5 * random.normal())};
  wet_number_ = 2.0 * pi / random.uniform(1200.0, 3000.0);
  wet_phase_ = random.uniform(0.0, 2.0 * pi);
  north_ = 4e-4 * random.normal();
  east_ = 4e-4 * random.normal();
  std::vector<double> radius, index, wet;
  for (int k = 0; k <= layers; ++k) {
    const double share = static_cast<double>(k) / layers;
    radius.push_back(earth_radius + height + (air_top - height) * share * share);
  }
  for (int k = 0; k < layers; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Refractivity n = refractivity(weather, 0.5 * (radius[i] + radius[i + 1]) - earth_radius);
    index.push_back(1.0 + 1e-6 * (n.dry + n.wet));
    wet.push_back(1e-6 * n.wet);
  }
  constexpr double satellite_radius = 26.6e6;  // m; the delay hardly depends on it
  radius.push_back(satellite_radius);
  index.push_back(1.0);
  wet.push_back(0.0);
  for (double apparent = radians(2.0); apparent < 0.5 * pi; apparent += radians(0.1)) {
    const double constant = index.front() * radius.front() * std::cos(apparent);
    double optical = 0.0, wet_delay = 0.0, angle = 0.0;
    for (std::size_t i = 0; i < index.size(); ++i) {
      const double nearest = constant / index[i];
      const auto along = [&](double r) { return std::sqrt(r * r - nearest * nearest); };
      const double length = along(radius[i + 1]) - along(radius[i]);
      optical += index[i] * length;
      wet_delay += wet[i] * length;
      angle += std::acos(nearest / radius[i + 1]) - std::acos(nearest / radius[i]);
    }
    const double x = satellite_radius * std::sin(angle);
    const double y = satellite_radius * std::cos(angle) - radius.front();
    table_.push_back({std::atan2(y, x), optical - std::hypot(x, y), wet_delay});
  }
}

double Troposphere::delay(double elevation, double azimuth, double t) const {
  const auto next = std::upper_bound(table_.begin() + 1, table_.end() - 1, elevation,
                                     [](double e, const Row& row) { return e < row.elevation; });
  const Row &a = *(next - 1), &b = *next;
  const double sine = std::sin(elevation);
  const double share =
      std::clamp((elevation - a.elevation) / (b.elevation - a.elevation), 0.0, 1.0);
  // The delay times the sine of elevation is nearly constant, so that it is interpolated.
  const auto between = [&](double Row::*member) {
    const double low = a.*member * std::sin(a.elevation), high = b.*member * std::sin(b.elevation);
    return (low + share * (high - low)) / sine;
  };
  const double slope = std::cos(elevation) / (sine * sine);
  return between(&Row::all) + 0.03 * std::sin(wet_number_ * t + wet_phase_) * between(&Row::wet) +
         slope * (north_ * std::cos(azimuth) + east_ * std::sin(azimuth));
}

Ionosphere::Ionosphere(const Geodetic& site, double day_start, std::uint64_t seed)
    : site_(site), day_start_(day_start) {
  Random random(seed, 23);
  level_ = random.uniform(0.6, 1.5);
  for (int i = 0; i < 5; ++i) {
    const double number = 2.0 * pi / random.uniform(150e3, 500e3);
    const double towards = random.uniform(0.0, 2.0 * pi);
    waves_.push_back({number * std::cos(towards), number * std::sin(towards),
                      2.0 * pi / random.uniform(900.0, 3600.0), random.uniform(0.0, 2.0 * pi),
                      random.uniform(0.05, 0.25)});
  }
}

double Ionosphere::electrons(double elevation, double azimuth, double t) const {
  constexpr double shell = 450e3;  // m
  const double sine = earth_radius / (earth_radius + shell) * std::cos(elevation);
  const double angle = 0.5 * pi - elevation - std::asin(sine);  // at the earth's centre
  const double north = angle * std::cos(azimuth), east = angle * std::sin(azimuth);
  const double latitude = site_.latitude + north;
  const double longitude = site_.longitude + east / std::cos(site_.latitude);
  const double hour_angle = 2.0 * pi * (day_start_ + t - 14.0 * 3600.0) / 86400.0 + longitude;
  const double day = std::max(0.0, std::cos(hour_angle));
  double vertical = level_ * (4.0 + 16.0 * day * std::sqrt(day) * std::cos(0.9 * latitude));
  const double reach = earth_radius + shell;
  for (const Wave& w : waves_)
    vertical += w.size * std::sin(reach * (w.north * north + w.east * east) - w.rate * t + w.phase);
  return vertical / std::sqrt(1.0 - sine * sine);
}

double ionospheric_delay(double electrons, double frequency) {
  return 40.3e16 * electrons / (frequency * frequency);
}

}  // namespace maploop::simulate
