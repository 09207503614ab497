#include "ppp/models/tides.h"

#include <cmath>
#include <numbers>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

using std::numbers::pi;

Eigen::Vector3d tide_of(const Eigen::Vector3d& up, double latitude, const Eigen::Vector3d& body,
                        double mass_ratio) {
  constexpr double radius = 6378136.6;
  const double distance = body.norm();
  const Eigen::Vector3d to_body = body / distance;
  const double k2 = mass_ratio * std::pow(radius, 4) / std::pow(distance, 3);
  const double k3 = k2 * radius / distance;
  const double p = (3.0 * std::pow(std::sin(latitude), 2) - 1.0) / 2.0;
  const double h2 = 0.6078 - 0.0006 * p, l2 = 0.0847 + 0.0002 * p;
  constexpr double h3 = 0.292, l3 = 0.015;
  const double a = to_body.dot(up);
  const Eigen::Vector3d across = to_body - a * up;
  return k2 * (h2 * (1.5 * a * a - 0.5) * up + 3.0 * l2 * a * across) +
         k3 * (h3 * (2.5 * a * a * a - 1.5 * a) * up + l3 * (7.5 * a * a - 1.5) * across);
}

}  // namespace

Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& site, const SunAndMoon& bodies) {
  const Eigen::Vector3d up = site.normalized();
  const double latitude = std::asin(up.z()), longitude = std::atan2(up.y(), up.x());
  Eigen::Vector3d d = tide_of(up, latitude, bodies.sun, 332946.0482) +
                      tide_of(up, latitude, bodies.moon, 0.0123000371);
  d -= 0.012 * std::sin(2.0 * latitude) * std::sin(bodies.sidereal_angle + longitude) * up;
  return d;
}

Eigen::Vector3d ocean_tide(const Eigen::Vector3d& site, const OceanLoading& loading, GpsTime t) {
  // Each row contains the angular speed (rad/s) and the multiples of the longitudes of the sun, the
  // moon and its perigee, and of a full turn.
  static constexpr double argument[11][5] = {
      {1.40519e-4, 2, -2, 0, 0},     {1.45444e-4, 0, 0, 0, 0},      {1.37880e-4, 2, -3, 1, 0},
      {1.45842e-4, 2, 0, 0, 0},      {0.72921e-4, 1, 0, 0, 0.25},   {0.67598e-4, 1, -2, 0, -0.25},
      {0.72523e-4, -1, 0, 0, -0.25}, {0.64959e-4, 1, -3, 1, -0.25}, {0.53234e-5, 0, 2, 0, 0},
      {0.26392e-5, 0, 1, -1, 0},     {0.03982e-5, 2, 0, 0, 0}};
  const double mjd = 44244.0 + to_seconds(to_utc(t) - Time(gps_epoch_day)) / 86400.0;
  const double day = std::floor(mjd);
  const double seconds = (mjd - day) * 86400.0;
  const double T = (27392.500528 + 1.000000035 * (day - 42412.0)) / 36525.0;
  const double sun = (279.69668 + 36000.768930485 * T + 3.03e-4 * T * T) * pi / 180.0;
  const double moon =
      (270.434358 + 481267.88314137 * T - 0.001133 * T * T + 1.9e-6 * T * T * T) * pi / 180.0;
  const double perigee =
      (334.329653 + 4069.0340329577 * T - 0.010325 * T * T - 1.2e-5 * T * T * T) * pi / 180.0;
  Eigen::Vector3d up_west_south = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 11; ++k) {
    const auto& a = argument[k];
    const double angle =
        a[0] * seconds + a[1] * sun + a[2] * moon + a[3] * perigee + a[4] * 2.0 * pi;
    for (std::size_t c = 0; c < 3; ++c) {
      up_west_south[static_cast<int>(c)] +=
          loading.amplitude[c][k] * std::cos(angle - loading.phase[c][k]);
    }
  }
  const Eigen::Vector3d enu(-up_west_south[1], -up_west_south[2], up_west_south[0]);
  return rotation_enu_ecef(geodetic_from_ecef(site)).transpose() * enu;
}

Eigen::Vector3d pole_tide(const Eigen::Vector3d& site, const SunAndMoon& earth) {
  if (!earth.has_pole) return Eigen::Vector3d::Zero();
  // The pole is taken relative to the secular pole (IERS 2018), in milliarcseconds at 2000 and per
  // year.
  const double years = (earth.mjd_ut1 - 51544.5) / 365.25;
  constexpr double to_arcsecond = 180.0 * 3600.0 / pi;
  const double m1 = earth.x_pole * to_arcsecond - (55.0 + 1.677 * years) * 1e-3;
  const double m2 = -(earth.y_pole * to_arcsecond - (320.5 + 3.460 * years) * 1e-3);
  const Geodetic g = geodetic_from_ecef(site);
  const double cl = std::cos(g.longitude), sl = std::sin(g.longitude);
  const Eigen::Vector3d enu(9e-3 * std::sin(g.latitude) * (m1 * sl - m2 * cl),
                            -9e-3 * std::cos(2.0 * g.latitude) * (m1 * cl + m2 * sl),
                            -33e-3 * std::sin(2.0 * g.latitude) * (m1 * cl + m2 * sl));
  return rotation_enu_ecef(g).transpose() * enu;
}

const OceanLoading* nearest_station(const std::vector<OceanLoadingFile>& files,
                                    const Eigen::Vector3d& site, const std::string& marker) {
  const OceanLoading* best = nullptr;
  double best_distance = 50e3;
  const std::string name = marker.substr(0, 4);
  for (const auto& file : files) {
    for (const OceanLoading& station : file.stations) {
      if (!name.empty() && station.station.substr(0, 4) == name) return &station;
      if (std::abs(station.latitude) > 90.0) continue;
      const Eigen::Vector3d p =
          ecef_from_geodetic({station.latitude * pi / 180.0, station.longitude * pi / 180.0, 0.0});
      const double distance = (p - site).norm();
      if (distance < best_distance) {
        best = &station;
        best_distance = distance;
      }
    }
  }
  return best;
}

}  // namespace maploop::ppp
