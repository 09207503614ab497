#include "ppp/models/troposphere.h"

#include <cmath>
#include <numbers>

#include "ppp/models/gmf_coefficients.h"

namespace maploop::ppp {
namespace {

using std::numbers::pi;

// This is Marini's continued fraction with Herring's normalization.
double fraction(double sine, const double (&c)[3]) {
  const double top = 1.0 + c[0] / (1.0 + c[1] / (1.0 + c[2]));
  return top / (sine + c[0] / (sine + c[1] / (sine + c[2])));
}

// Contains the spherical harmonics at a place, without normalization.
class Harmonics {
 public:
  explicit Harmonics(const Geodetic& site) {
    constexpr int n = gmf::degree;
    const double x = std::sin(site.latitude), y = std::cos(site.latitude);
    double p[n + 1][n + 1] = {};
    p[0][0] = 1.0;
    for (int m = 1; m <= n; ++m) p[m][m] = (2 * m - 1) * y * p[m - 1][m - 1];
    for (int m = 0; m < n; ++m) p[m + 1][m] = (2 * m + 1) * x * p[m][m];
    for (int m = 0; m <= n; ++m) {
      for (int i = m + 2; i <= n; ++i)
        p[i][m] = ((2 * i - 1) * x * p[i - 1][m] - (i + m - 1) * p[i - 2][m]) / (i - m);
    }
    std::size_t k = 0;
    for (int i = 0; i <= n; ++i) {
      for (int m = 0; m <= i; ++m, ++k) {
        cosine_[k] = 1e-5 * p[i][m] * std::cos(m * site.longitude);
        sine_[k] = 1e-5 * p[i][m] * std::sin(m * site.longitude);
      }
    }
  }
  double sum(const gmf::Coefficients& cosine, const gmf::Coefficients& sine) const {
    double total = 0.0;
    for (std::size_t k = 0; k < cosine.size(); ++k)
      total += cosine[k] * cosine_[k] + sine[k] * sine_[k];
    return total;
  }

 private:
  gmf::Coefficients cosine_{}, sine_{};
};

}  // namespace

GlobalMapping::GlobalMapping(const Geodetic& site, GpsTime t) : height_km_(site.height * 1e-3) {
  constexpr double seconds_a_day = 86400.0;
  // The coldest day is 28 January, in the north.
  const double day = to_seconds(t.time_since_epoch()) / seconds_a_day - 22.0;
  const double season = std::cos(2.0 * pi * day / 365.25);
  const Harmonics harmonics(site);
  const bool south = site.latitude < 0.0;
  const double c10 = south ? 0.002 : 0.001, c11 = south ? 0.007 : 0.005;
  hydrostatic_[0] =
      harmonics.sum(gmf::hydrostatic_mean_cosine, gmf::hydrostatic_mean_sine) +
      season * harmonics.sum(gmf::hydrostatic_amplitude_cosine, gmf::hydrostatic_amplitude_sine);
  hydrostatic_[1] = 0.0029;
  hydrostatic_[2] = 0.062 + ((1.0 + (south ? -season : season)) * c11 / 2.0 + c10) *
                                (1.0 - std::cos(site.latitude));
  wet_[0] = harmonics.sum(gmf::wet_mean_cosine, gmf::wet_mean_sine) +
            season * harmonics.sum(gmf::wet_amplitude_cosine, gmf::wet_amplitude_sine);
  wet_[1] = 0.00146;
  wet_[2] = 0.04391;
}

Mapping GlobalMapping::at(double elevation) const {
  static constexpr double by_height[3] = {2.53e-5, 5.49e-3, 1.14e-3};  // Niell 1996
  const double sine = std::sin(elevation);
  return {fraction(sine, hydrostatic_) + (1.0 / sine - fraction(sine, by_height)) * height_km_,
          fraction(sine, wet_)};
}

}  // namespace maploop::ppp
