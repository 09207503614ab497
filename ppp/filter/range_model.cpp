#include "ppp/filter/range_model.h"

#include <cmath>

namespace maploop::ppp {
namespace {

constexpr double earth_gravity = 3.986004418e14;  // m^3/s^2, WGS84
constexpr double lowest_with_models = 0.01;       // rad; below it the models are not valid

// The delay of light in the earth's gravity (Shapiro), m; all distances are in m.
double shapiro_delay(double satellite_radius, double receiver_radius, double distance) {
  constexpr double twice_mass = 2.0 * earth_gravity / (speed_of_light * speed_of_light);
  const double a = satellite_radius + receiver_radius;
  return twice_mass * std::log((a + distance) / (a - distance));
}

}  // namespace

double PredictedRange::code(const Measurement& m, Combination c) const {
  return with_antennas(m.weights(c)) + m.ionosphere(c) * ionosphere.value;
}

double PredictedRange::phase(const Measurement& m, Combination c) const {
  const auto weights = m.weights(c);
  const double turn = weights[0] * m.first.wavelength + weights[1] * m.second.wavelength;
  return with_antennas(weights) + wind_up * turn - m.ionosphere(c) * ionosphere.value;
}

double PredictedRange::with_antennas(const std::array<double, 2>& weights) const {
  return (weights[0] + weights[1]) * range + weights[0] * antennas[0] + weights[1] * antennas[1];
}

void RangeModel::begin(GpsTime t, const Eigen::Vector3d& marker) {
  time_ = t;
  const auto day = std::chrono::floor<std::chrono::days>(t);
  if (inputs_.antennas != nullptr && (!antennas_ || day != antennas_day_)) {
    antennas_.emplace(*inputs_.antennas, t);
    antennas_day_ = day;
  }
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

// The code gives the time of transmission on the satellite's clock, and the clock's offset then
// gives it in GPS time.
std::optional<SatelliteState> RangeModel::transmitter(const Measurement& m) const {
  const GpsTime sent = time_ - from_seconds(m.first.code / speed_of_light);
  const auto offset = inputs_.ephemeris->clock(m.satellite, sent);
  if (!offset) return {};
  return inputs_.ephemeris->at(m.satellite, sent - from_seconds(*offset));
}

std::optional<PredictedRange> RangeModel::predict(const Measurement& m,
                                                  double& wind_up_cycles) const {
  const auto state = transmitter(m);
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
  if (p.elevation <= lowest_with_models) return p;

  const Models& use = inputs_.models;
  if (use.shapiro) p.range += shapiro_delay(s.norm(), receiver_.norm(), distance);
  const Mapping mapping = mapping_.at(p.elevation);
  p.wet_mapping = mapping.wet;
  p.range += mapping.hydrostatic * zenith_.hydrostatic + mapping.wet * zenith_.wet;
  const bool masses = inputs_.ephemeris->centre_of_mass();
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
  const auto known = inputs_.ephemeris->attitude(m.satellite, time_);
  if (known) {
    attitude = known->toRotationMatrix();
  } else if (masses || use.wind_up) {
    attitude = nominal_attitude(s, bodies_.sun);
  }
  add_phase_centres(m, attitude, local, p);
  if (use.wind_up) {
    wind_up_cycles = wind_up(attitude, R_enu_ecef_, difference, wind_up_cycles);
    p.wind_up = wind_up_cycles;
  }
  p.in_shadow = masses && !known && in_shadow(s, bodies_.sun);  // where it may turn otherwise
  p.ionosphere = ionosphere(p.azimuth, p.elevation);
  p.ionosphere_slant = ionospheric_slant(p.elevation);
  p.ionosphere_distance = ionospheric_distance(p.elevation);
  return p;
}

IonosphericDelay RangeModel::ionosphere(double azimuth, double elevation) const {
  for (const ElectronContent* known : inputs_.electrons) {
    if (known == nullptr) continue;
    if (const auto electrons = known->at(pierce_point(site_, azimuth, elevation), time_))
      return ionospheric_delay(*electrons, elevation);
  }
  return ionospheric_delay(coefficients_, site_, azimuth, elevation, time_);
}

void RangeModel::add_phase_centres(const Measurement& m, const Eigen::Matrix3d& attitude,
                                   const Eigen::Vector3d& to_satellite_enu,
                                   PredictedRange& p) const {
  const System system = m.satellite.system;
  const bool of_satellites = inputs_.ephemeris->centre_of_mass() &&
                             inputs_.models.satellite_antenna && inputs_.antennas != nullptr;
  if (of_satellites) {
    const AssumedAntenna& assumed = antennas_->assumed(system);
    const Antenna* own = antennas_->of(m.satellite);
    p.calibrated = own != nullptr && own->carrier(system, m.first.band) != nullptr &&
                   (!m.dual() || own->carrier(system, m.second.band) != nullptr);
    if (own == nullptr) p.satellite.sigma = std::hypot(p.satellite.sigma, assumed.sigma);
    const Antenna& antenna = own != nullptr ? *own : assumed.antenna;
    for (std::size_t k = 0; k < m.carriers(); ++k) {
      p.antennas[k] +=
          satellite_phase_centre(antenna, system, m.carrier(k).band, attitude, -p.to_satellite);
    }
  } else {
    p.calibrated = !inputs_.ephemeris->centre_of_mass();
  }
  if (inputs_.models.receiver_antenna && inputs_.receiver != nullptr) {
    for (std::size_t k = 0; k < m.carriers(); ++k) {
      p.antennas[k] +=
          receiver_phase_centre(*inputs_.receiver, system, m.carrier(k).band, to_satellite_enu);
    }
  }
}

}  // namespace maploop::ppp
