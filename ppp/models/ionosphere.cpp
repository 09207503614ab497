#include "ppp/models/ionosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "ppp/satellite.h"

namespace maploop::ppp {
namespace {

using std::numbers::pi;

constexpr double earth_radius = 6371.0, shell_height = 450.0;  // km

double square(double x) {
  return x * x;
}

double delay(const Klobuchar& klobuchar, const Geodetic& site, double azimuth, double elevation,
             GpsTime t) {
  const auto& k = klobuchar.values;
  // Angles are in semicircles, as in the interface document.
  const double e = elevation / pi;
  const double psi = 0.0137 / (e + 0.11) - 0.022;
  const double phi = std::clamp(site.latitude / pi + psi * std::cos(azimuth), -0.416, 0.416);
  const double lambda = site.longitude / pi + psi * std::sin(azimuth) / std::cos(phi * pi);
  const double magnetic = phi + 0.064 * std::cos((lambda - 1.617) * pi);
  double local = std::fmod(43200.0 * lambda + seconds_of_week(t), 86400.0);
  if (local < 0.0) local += 86400.0;
  const double slant = 1.0 + 16.0 * std::pow(0.53 - e, 3);
  const double amp = std::max(0.0, k[0] + magnetic * (k[1] + magnetic * (k[2] + magnetic * k[3])));
  const double period =
      std::max(72000.0, k[4] + magnetic * (k[5] + magnetic * (k[6] + magnetic * k[7])));
  const double x = 2.0 * pi * (local - 50400.0) / period;
  const double bump = std::abs(x) < 1.57 ? amp * (1.0 - x * x / 2.0 + x * x * x * x / 24.0) : 0.0;
  return speed_of_light * slant * (5e-9 + bump);
}

// Returns the angle at the earth's centre between the receiver and the crossing, rad.
double pierce_angle(double elevation) {
  return pi / 2.0 - elevation -
         std::asin(earth_radius / (earth_radius + shell_height) * std::cos(elevation));
}

// Returns the vertical electron content above a place, TECU. Names and constants are those of
// NTCM-G's description.
double vertical_electrons(const IonisationLevel& level, const PiercePoint& at, int day_of_year,
                          double hour) {
  const auto& a = level.values;
  const double local = hour + at.longitude * 12.0 / pi;  // h
  const double declination = radians(23.44) * std::sin(radians(0.9856 * (day_of_year - 80.7)));
  const double day = 2.0 * pi * (local - 14.0) / 24.0, half = 2.0 * pi * local / 12.0,
               third = 2.0 * pi * local / 8.0;
  const double height_of_sun = std::cos(at.latitude - declination);
  const double daily =
      height_of_sun + 0.4 +
      (height_of_sun - 2.0 / pi * at.latitude * std::sin(declination)) *
          (0.92519 * std::cos(day) + 0.16951 * std::cos(half) + 0.00443 * std::sin(half) +
           0.06626 * std::cos(third) + 0.00899 * std::sin(third));
  const double seasonal = 1.0 + 0.21289 * std::cos(2.0 * pi * (day_of_year - 18) / 365.25) -
                          0.15414 * std::cos(4.0 * pi * (day_of_year - 6) / 365.25);
  constexpr double pole_latitude = radians(79.74), pole_longitude = radians(-71.78);
  const double magnetic = std::asin(std::clamp(
      std::sin(at.latitude) * std::sin(pole_latitude) +
          std::cos(at.latitude) * std::cos(pole_latitude) * std::cos(at.longitude - pole_longitude),
      -1.0, 1.0));
  const double by_latitude = 1.0 - 0.38439 * std::cos(magnetic);
  const auto crest = [magnetic](double degrees, double width) {
    return std::exp(-0.5 * square((magnetic - radians(degrees)) / radians(width)));
  };
  const double crests = 1.0 + 1.14023 * crest(16.0, 12.0) + 1.20556 * crest(-10.0, 13.0);
  const double flux =
      std::sqrt(std::max(0.0, square(a[0]) + 1633.33 * square(a[1]) + 4802000.0 * square(a[2]) +
                                  3266.67 * a[0] * a[2]));
  const double by_flux = 1.41808 + 0.13985 * flux;
  return std::max(0.0, daily * seasonal * by_latitude * crests * by_flux);
}

double delay(const IonisationLevel& level, const Geodetic& site, double azimuth, double elevation,
             GpsTime t) {
  const Time utc = to_utc(t);
  const auto today = std::chrono::floor<std::chrono::days>(utc);
  const std::chrono::sys_days new_year{std::chrono::year_month_day{today}.year() / 1 / 1};
  const int day_of_year = static_cast<int>((today - new_year).count()) + 1;
  const double electrons = vertical_electrons(level, pierce_point(site, azimuth, elevation),
                                              day_of_year, to_seconds(utc - today) / 3600.0);
  return delay_of_electrons * ionospheric_slant(elevation) * electrons;
}

}  // namespace

PiercePoint pierce_point(const Geodetic& site, double azimuth, double elevation) {
  const double angle = pierce_angle(elevation);
  const double latitude = std::asin(std::sin(site.latitude) * std::cos(angle) +
                                    std::cos(site.latitude) * std::sin(angle) * std::cos(azimuth));
  const double sine = std::sin(angle) * std::sin(azimuth) / std::cos(latitude);
  return {latitude, site.longitude + std::asin(std::clamp(sine, -1.0, 1.0))};
}

double ionospheric_distance(double elevation) {
  return 1e-3 * earth_radius * pierce_angle(elevation);
}

double ionospheric_slant(double elevation) {
  const double sine =
      earth_radius / (earth_radius + shell_height) * std::sin(0.9782 * (pi / 2.0 - elevation));
  return 1.0 / std::sqrt(1.0 - square(sine));
}

double ionospheric_delay(const IonosphereCoefficients& coefficients, const Geodetic& site,
                         double azimuth, double elevation, GpsTime t) {
  return std::visit([&](const auto& c) { return delay(c, site, azimuth, elevation, t); },
                    coefficients);
}

}  // namespace maploop::ppp
