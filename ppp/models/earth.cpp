#include "ppp/models/earth.h"

#include <erfa.h>
#include <erfam.h>

#include <algorithm>
#include <cmath>

namespace maploop::ppp {
namespace {

constexpr double mjd_zero = 2400000.5;

// Returns the modified Julian date of a moment, in GPS time.
double mjd_of(GpsTime t) {
  return 44244.0 + to_seconds(t.time_since_epoch()) / 86400.0;
}

Eigen::Matrix3d matrix(const double m[3][3]) {
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) r(i, k) = m[i][k];
  }
  return r;
}

}  // namespace

Earth::Earth(const std::vector<EarthRotationFile>& files) {
  for (const auto& file : files) days_.insert(days_.end(), file.days.begin(), file.days.end());
  std::sort(days_.begin(), days_.end(),
            [](const EarthRotation& a, const EarthRotation& b) { return a.mjd < b.mjd; });
}

EarthRotation Earth::rotation_at(double mjd) const {
  const auto after = std::lower_bound(days_.begin(), days_.end(), mjd,
                                      [](const EarthRotation& d, double m) { return d.mjd < m; });
  if (after == days_.end() || (after == days_.begin() && after->mjd > mjd)) return {};
  if (after == days_.begin()) return *after;
  const EarthRotation &a = *(after - 1), &b = *after;
  const double share = (mjd - a.mjd) / (b.mjd - a.mjd);
  EarthRotation r = a;
  r.mjd = mjd;
  r.x_pole += share * (b.x_pole - a.x_pole);
  r.y_pole += share * (b.y_pole - a.y_pole);
  // There may be a leap second in between.
  const double step = b.ut1_minus_utc - a.ut1_minus_utc;
  r.ut1_minus_utc += share * (step - std::round(step));
  return r;
}

const SunAndMoon& Earth::at(GpsTime t) {
  const double mjd_gps = mjd_of(t);
  const double mjd_utc = mjd_gps - to_seconds(leap_seconds(t).gps_minus_utc) / 86400.0;
  const EarthRotation rotation = rotation_at(mjd_utc);
  // The slow parts are those of the minute's middle, whichever of its epochs comes first, so that
  // the same time gives the same bits.
  const GpsTime middle = std::chrono::floor<std::chrono::minutes>(t) + std::chrono::seconds(30);
  if (slow_time_ != middle) {
    const double mjd_tt = mjd_of(middle) + (19.0 + 32.184) / 86400.0;
    double bpn[3][3], heliocentric[2][3], barycentric[2][3], moon[2][3];
    eraPnm00b(mjd_zero, mjd_tt, bpn);
    celestial_to_intermediate_ = matrix(bpn);
    eraEpv00(mjd_zero, mjd_tt, heliocentric, barycentric);
    eraMoon98(mjd_zero, mjd_tt, moon);
    for (int i = 0; i < 3; ++i) {
      sun_[i] = -heliocentric[0][i] * ERFA_DAU;
      moon_[i] = moon[0][i] * ERFA_DAU;
    }
    slow_time_ = middle;
  }
  now_.mjd_ut1 = mjd_utc + rotation.ut1_minus_utc / 86400.0;
  now_.sidereal_angle = eraGst00b(mjd_zero, now_.mjd_ut1);
  now_.x_pole = rotation.x_pole;
  now_.y_pole = rotation.y_pole;
  now_.has_pole = rotation.mjd > 0.0;
  const double c = std::cos(now_.sidereal_angle), s = std::sin(now_.sidereal_angle);
  Eigen::Matrix3d turn;
  turn << c, s, 0, -s, c, 0, 0, 0, 1;
  const Eigen::Matrix3d to_fixed = turn * celestial_to_intermediate_;
  now_.sun = to_fixed * sun_;
  now_.moon = to_fixed * moon_;
  return now_;
}

}  // namespace maploop::ppp
