#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "msgs/lcm/conversion_parts.h"
#include "msgs/lcm/conversions.h"

namespace maploop {
namespace {

maploop_lcm::ppp_satellite_t to_lcm(const PppSatellite& s) {
  maploop_lcm::ppp_satellite_t m{};
  m.name = {s.system, static_cast<char>('0' + s.number / 10),
            static_cast<char>('0' + s.number % 10)};
  m.azimuth = s.azimuth;
  m.elevation = s.elevation;
  m.cn0 = s.cn0;
  m.code_used = s.code_used ? 1 : 0;
  m.phase_used = s.phase_used ? 1 : 0;
  m.code_residual = s.code_residual;
  m.phase_residual = s.phase_residual;
  m.refusal = static_cast<std::int8_t>(s.refusal);
  m.slip = static_cast<std::int8_t>(s.slip);
  return m;
}

PppSatellite from_lcm(const maploop_lcm::ppp_satellite_t& m) {
  PppSatellite s;
  const char* const end = m.name.data() + m.name.size();
  if (m.name.size() != 3 || std::from_chars(m.name.data() + 1, end, s.number).ptr != end) {
    throw std::invalid_argument("ppp_satellite_t.name is no satellite");
  }
  s.system = m.name[0];
  s.azimuth = m.azimuth;
  s.elevation = m.elevation;
  s.cn0 = m.cn0;
  s.code_used = m.code_used != 0;
  s.phase_used = m.phase_used != 0;
  s.code_residual = m.code_residual;
  s.phase_residual = m.phase_residual;
  s.refusal = enumerator_from(m.refusal, PppRefusal::too_many, "ppp_satellite_t.refusal");
  s.slip = enumerator_from(m.slip, PppSlip::phase_step, "ppp_satellite_t.slip");
  return s;
}

}  // namespace

maploop_lcm::ppp_state_t to_lcm(const PppState& state) {
  maploop_lcm::ppp_state_t m{};
  m.header = header_of(state);
  m.status = static_cast<std::int8_t>(state.status);
  m.message = state.message;
  m.latitude = state.position.latitude;
  m.longitude = state.position.longitude;
  m.height = state.position.height;
  write<3>(state.position_covariance, m.position_covariance);
  write<3>(state.velocity_enu, m.velocity_enu);
  write<3>(state.velocity_covariance, m.velocity_covariance);
  m.protection_along = state.protection.along;
  m.protection_across = state.protection.across;
  m.protection_up = state.protection.up;
  m.integrity_risk = state.integrity_risk;
  m.zenith_delay = state.zenith_delay;
  m.zenith_delay_sigma = state.zenith_delay_sigma;
  m.code_rms = state.code_rms;
  m.phase_rms = state.phase_rms;
  m.converging_for = state.converging_for;
  m.restarts = static_cast<std::int64_t>(state.restarts);
  m.map = static_cast<std::int8_t>(state.map);
  m.roads_used = static_cast<std::int64_t>(state.roads_used);
  m.roads_refused = static_cast<std::int64_t>(state.roads_refused);
  m.satellites_used = state.satellites_used;
  m.satellites_corrected = state.satellites_corrected;
  m.correction_age = state.correction_age.value_or(std::numeric_limits<double>::quiet_NaN());
  convert_each(state.satellites, m.satellites, to_lcm);
  m.satellite_count = static_cast<std::int32_t>(m.satellites.size());
  return m;
}

PppState from_lcm(const maploop_lcm::ppp_state_t& m) {
  PppState state;
  set_sample(state, m.header);
  state.status = enumerator_from(m.status, PppStatus::converged, "ppp_state_t.status");
  state.message = m.message;
  state.position = {m.latitude, m.longitude, m.height};
  read<3>(m.position_covariance, state.position_covariance);
  read<3>(m.velocity_enu, state.velocity_enu);
  read<3>(m.velocity_covariance, state.velocity_covariance);
  state.protection = {m.protection_along, m.protection_across, m.protection_up};
  state.integrity_risk = m.integrity_risk;
  state.zenith_delay = m.zenith_delay;
  state.zenith_delay_sigma = m.zenith_delay_sigma;
  state.code_rms = m.code_rms;
  state.phase_rms = m.phase_rms;
  state.converging_for = m.converging_for;
  state.restarts = static_cast<std::uint64_t>(m.restarts);
  state.map = enumerator_from(m.map, PppMap::paused, "ppp_state_t.map");
  state.roads_used = static_cast<std::uint64_t>(m.roads_used);
  state.roads_refused = static_cast<std::uint64_t>(m.roads_refused);
  state.satellites_used = m.satellites_used;
  state.satellites_corrected = m.satellites_corrected;
  if (!std::isnan(m.correction_age)) state.correction_age = m.correction_age;
  convert_each(m.satellites, state.satellites, from_lcm);
  return state;
}

}  // namespace maploop
