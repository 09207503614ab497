#include "estimators/fusion/earth.h"

#include <cmath>

namespace maploop::fusion {
namespace {

constexpr double semi_major_axis = 6378137.0;  // m
constexpr double eccentricity_squared = 0.00669437999014;
constexpr double earth_spin = 7.2921151467e-5;  // rad/s

double flattening_term(double latitude) {
  const double s = std::sin(latitude);
  return 1.0 - eccentricity_squared * s * s;
}

}  // namespace

double normal_gravity(double latitude, double height) {
  const double s2 = std::pow(std::sin(latitude), 2);
  return 9.7803267714 * (1.0 + 0.0052790414 * s2 + 0.0000232718 * s2 * s2) +
         (-3.0876910891e-6 + 4.3977311e-9 * s2) * height + 7.211e-13 * height * height;
}

double prime_vertical_radius(double latitude) {
  return semi_major_axis / std::sqrt(flattening_term(latitude));
}

double meridian_radius(double latitude) {
  return semi_major_axis * (1.0 - eccentricity_squared) / std::pow(flattening_term(latitude), 1.5);
}

LocalEarth::LocalEarth(const Geodetic& origin)
    : latitude_(origin.latitude),
      height_(origin.height),
      earth_rate_(0.0, earth_spin * std::cos(origin.latitude),
                  earth_spin * std::sin(origin.latitude)),
      curvature_(1.0 / (prime_vertical_radius(origin.latitude) + origin.height),
                 1.0 / (meridian_radius(origin.latitude) + origin.height)) {}

double LocalEarth::gravity(double up) const {
  return normal_gravity(latitude_, height_ + up);
}

}  // namespace maploop::fusion
