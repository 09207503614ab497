#include "ppp/filter/range_model.h"

#include <cmath>

namespace maploop::ppp {

void RangeModel::begin(GpsTime t, const Eigen::Vector3d& marker) {
  time_ = t;
  site_ = geodetic_from_ecef(marker);
  R_enu_ecef_ = rotation_enu_ecef(site_);
  bodies_ = earth_.at(t);
  receiver_ = marker + R_enu_ecef_.transpose() * inputs_.marker_to_antenna_enu;
  const Models& use = inputs_.models;
  if (use.solid_tide) receiver_ += solid_earth_tide(marker, bodies_);
  if (use.pole_tide) receiver_ += pole_tide(marker, bodies_);
  if (use.ocean_tide && inputs_.ocean_loading) {
    receiver_ += ocean_tide(marker, *inputs_.ocean_loading, t);
  }
  zenith_ = zenith_delay(site_, t);
  mapping_ = GlobalMapping(site_, t);
  if (inputs_.ionosphere) coefficients_ = inputs_.ionosphere->at(t);
}

std::optional<PredictedRange> RangeModel::predict(const Measurement& m,
                                                  double& wind_up_cycles) const {
  // The code gives the time of transmission on the satellite's clock, and the clock's offset then
  // gives it in GPS time.
  GpsTime sent = time_ - from_seconds(m.first.code / speed_of_light);
  const auto offset = inputs_.ephemeris->clock(m.satellite, sent);
  if (!offset) return {};
  sent -= from_seconds(*offset);
  const auto state = inputs_.ephemeris->at(m.satellite, sent);
  if (!state) return {};

  PredictedRange p;
  p.satellite = *state;
  const Eigen::Vector3d& s = state->position;
  const Eigen::Vector3d difference = s - receiver_;
  const double distance = difference.norm();
  const double sagnac =
      earth_rotation_rate / speed_of_light * (s.x() * receiver_.y() - s.y() * receiver_.x());
  p.range = distance + sagnac - speed_of_light * state->clock;  // (4) of METHOD.md
  p.to_satellite = difference / distance;
  const Eigen::Vector3d local = R_enu_ecef_ * p.to_satellite;
  p.azimuth = std::atan2(local.x(), local.y());
  p.elevation = std::asin(local.z());
  if (p.elevation <= 0.01) return p;  // below the horizon the models are not valid

  const Models& use = inputs_.models;
  if (use.shapiro) {
    constexpr double twice_mass = 2.0 * 3.986004418e14 / (speed_of_light * speed_of_light);
    const double a = s.norm() + receiver_.norm();
    p.range += twice_mass * std::log((a + distance) / (a - distance));
  }
  const Mapping mapping = mapping_.at(p.elevation);
  p.wet_mapping = mapping.wet;
  p.range += mapping.hydrostatic * zenith_.hydrostatic + mapping.wet * zenith_.wet;

  const bool masses = inputs_.ephemeris->centre_of_mass();
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
  if (masses || use.wind_up) attitude = nominal_attitude(s, bodies_.sun);
  const auto combined = [&](auto&& of_band) {
    double sum = m.weight1() * of_band(m.first.band);
    if (m.dual()) sum += m.weight2() * of_band(m.second.band);
    return sum;
  };
  if (masses && use.satellite_antenna && inputs_.antennas) {
    if (const Antenna* antenna = satellite_antenna(*inputs_.antennas, m.satellite, time_)) {
      p.range += combined([&](char band) {
        return satellite_phase_centre(*antenna, m.satellite.system, band, attitude,
                                      -p.to_satellite);
      });
    }
  }
  if (use.receiver_antenna && inputs_.receiver) {
    p.range += combined([&](char band) {
      return receiver_phase_centre(*inputs_.receiver, m.satellite.system, band, local);
    });
  }
  if (use.wind_up) {
    wind_up_cycles = wind_up(attitude, R_enu_ecef_, difference, wind_up_cycles);
    p.phase_extra = wind_up_cycles * (m.weight1() * m.first.wavelength +
                                      (m.dual() ? m.weight2() * m.second.wavelength : 0.0));
  }
  p.in_shadow = masses && in_shadow(s, bodies_.sun);
  if (!m.dual()) {
    const double ratio = carrier_frequency(System::gps, '1') / m.first.frequency;
    const auto on_l1 = ionospheric_delay(coefficients_, site_, p.azimuth, p.elevation, time_);
    p.ionosphere = {ratio * ratio * on_l1.value, ratio * ratio * on_l1.sigma};
  }
  return p;
}

}  // namespace maploop::ppp
