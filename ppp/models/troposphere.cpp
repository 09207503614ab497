#include "ppp/models/troposphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ppp/models/atmosphere.h"
#include "ppp/satellite.h"

namespace maploop::ppp {
namespace {

using std::numbers::pi;

// Continued fraction of Marini with Herring's normalization.
double fraction(double sine, const double (&c)[3]) {
  const double top = 1.0 + c[0] / (1.0 + c[1] / (1.0 + c[2]));
  return top / (sine + c[0] / (sine + c[1] / (sine + c[2])));
}

// Tables at 15, 30, 45, 60 and 75 degrees of latitude.
double between(const double (&table)[5], double latitude_degrees) {
  const double place = std::clamp(latitude_degrees / 15.0 - 1.0, 0.0, 4.0);
  const int i = std::min(3, static_cast<int>(place));
  return table[i] + (place - i) * (table[i + 1] - table[i]);
}

constexpr double hydrostatic_mean[3][5] = {
    {1.2769934e-3, 1.2683230e-3, 1.2465397e-3, 1.2196049e-3, 1.2045996e-3},
    {2.9153695e-3, 2.9152299e-3, 2.9288445e-3, 2.9022565e-3, 2.9024912e-3},
    {62.610505e-3, 62.837393e-3, 63.721774e-3, 63.824265e-3, 64.258455e-3}};
constexpr double hydrostatic_amplitude[3][5] = {
    {0.0, 1.2709626e-5, 2.6523662e-5, 3.4000452e-5, 4.1202191e-5},
    {0.0, 2.1414979e-5, 3.0160779e-5, 7.2562722e-5, 11.723375e-5},
    {0.0, 9.0128400e-5, 4.3497037e-5, 84.795348e-5, 170.37206e-5}};
constexpr double wet_table[3][5] = {
    {5.8021897e-4, 5.6794847e-4, 5.8118019e-4, 5.9727542e-4, 6.1641693e-4},
    {1.4275268e-3, 1.5138625e-3, 1.4572752e-3, 1.5007428e-3, 1.7599082e-3},
    {4.3472961e-2, 4.6729510e-2, 4.3908931e-2, 4.4626982e-2, 5.4736038e-2}};

}  // namespace

NiellMapping::NiellMapping(const Geodetic& site, GpsTime t) : height_km_(site.height * 1e-3) {
  const double day = day_of_year(t) + (site.latitude < 0 ? 182.6 : 0.0);
  const double season = std::cos(2.0 * pi * (day - 28.0) / 365.25);
  const double latitude = std::abs(site.latitude) * 180.0 / pi;
  for (int i = 0; i < 3; ++i) {
    hydrostatic_[i] = between(hydrostatic_mean[i], latitude) -
                      between(hydrostatic_amplitude[i], latitude) * season;
    wet_[i] = between(wet_table[i], latitude);
  }
}

Mapping NiellMapping::at(double elevation) const {
  static constexpr double by_height[3] = {2.53e-5, 5.49e-3, 1.14e-3};
  const double sine = std::sin(elevation);
  return {fraction(sine, hydrostatic_) + (1.0 / sine - fraction(sine, by_height)) * height_km_,
          fraction(sine, wet_)};
}

double klobuchar_delay(const std::array<double, 8>& k, const Geodetic& site, double azimuth,
                       double elevation, GpsTime t) {
  // In semicircles, as the interface document writes it.
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

}  // namespace maploop::ppp
