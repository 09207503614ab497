#include "ppp/epoch_state.h"

#include <cmath>

#include "msgs/protection_levels.h"
#include "ppp/models/geodesy.h"

namespace maploop::ppp {
namespace {

PppSatellite satellite_of(const SatelliteReport& r) {
  PppSatellite s;
  s.system = letter(r.satellite.system);
  s.number = r.satellite.number;
  s.azimuth = static_cast<float>(r.azimuth);
  s.elevation = static_cast<float>(r.elevation);
  s.cn0 = static_cast<float>(r.cn0);
  s.code_used = r.code_used;
  s.phase_used = r.phase_used;
  s.code_residual = static_cast<float>(r.code_residual);
  s.phase_residual = static_cast<float>(r.phase_residual);
  s.refusal = r.refused;
  s.slip = r.slip;
  return s;
}

double root_mean(double sum, int count) {
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

void set_residuals(const PppSolution& solution, PppState& state) {
  double codes = 0.0, phases = 0.0;
  int code_count = 0, phase_count = 0;
  for (const SatelliteReport& r : solution.satellites) {
    if (r.code_used) {
      codes += r.code_residual * r.code_residual;
      ++code_count;
    }
    if (r.phase_used) {
      phases += r.phase_residual * r.phase_residual;
      ++phase_count;
    }
  }
  state.code_rms = root_mean(codes, code_count);
  state.phase_rms = root_mean(phases, phase_count);
}

}  // namespace

void describe(const PppSolution& solution, double integrity_risk, PppState& state) {
  state.status = solution.status;
  state.message = solution.message;
  state.satellites_used = solution.satellites_used;
  state.converging_for = solution.running_for;
  state.restarts = solution.restarts;
  state.satellites.clear();
  for (const SatelliteReport& r : solution.satellites) state.satellites.push_back(satellite_of(r));
  set_residuals(solution, state);
  state.integrity_risk = integrity_risk;
  if (solution.status == PppStatus::none) {
    state.position = {};
    state.position_covariance.setZero();
    state.velocity_enu.setZero();
    state.velocity_covariance.setZero();
    state.protection = {};
    state.zenith_delay = state.zenith_delay_sigma = 0.0;
    return;
  }
  state.position = geodetic_from_ecef(solution.position);
  const Eigen::Matrix3d R = rotation_enu_ecef(state.position);
  state.position_covariance = R * solution.covariance * R.transpose();
  state.velocity_enu = R * solution.velocity;
  state.velocity_covariance = R * solution.velocity_covariance * R.transpose();
  state.protection = protection_levels(state.position_covariance, state.velocity_enu,
                                       integrity_factor(integrity_risk));
  state.zenith_delay = solution.zenith_delay;
  state.zenith_delay_sigma = solution.zenith_delay_sigma;
}

void describe_map(const MapAidedFilter& filter, PppState& state) {
  state.map = filter.aided() ? PppMap::aiding : filter.paused() ? PppMap::paused : PppMap::none;
  state.roads_used = filter.count(MapUse::used);
  state.roads_refused = 0;
  for (const MapUse use : {MapUse::not_usable, MapUse::no_position, MapUse::not_of_this_epoch,
                           MapUse::no_help, MapUse::gated, MapUse::paused}) {
    state.roads_refused += filter.count(use);
  }
}

GnssFix to_fix(const PppState& state) {
  GnssFix fix;
  static_cast<Sample&>(fix) = state;
  fix.position = state.position;
  fix.position_covariance = state.position_covariance;
  fix.velocity_stamp = state.stamp;
  fix.velocity_enu = state.velocity_enu;
  fix.velocity_covariance = state.velocity_covariance;
  return fix;
}

}  // namespace maploop::ppp
