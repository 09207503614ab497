#include <charconv>

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/field_copy.h"

namespace maploop {

void convert(auto copy, Is<PppSatellite> auto& s, auto& m) {
  if constexpr (copy.to_message) {
    m.name = {s.system, static_cast<char>('0' + s.number / 10),
              static_cast<char>('0' + s.number % 10)};
  } else {
    const char* const end = m.name.data() + m.name.size();
    if (m.name.size() != 3 || std::from_chars(m.name.data() + 1, end, s.number).ptr != end) {
      throw std::invalid_argument("ppp_satellite_t.name is not a satellite");
    }
    s.system = m.name[0];
  }
  copy(s.azimuth, m.azimuth);
  copy(s.elevation, m.elevation);
  copy(s.cn0, m.cn0);
  copy(s.code_used, m.code_used);
  copy(s.phase_used, m.phase_used);
  copy(s.code_residual, m.code_residual);
  copy(s.phase_residual, m.phase_residual);
  copy.choice(s.refusal, m.refusal, "ppp_satellite_t.refusal");
  copy.choice(s.slip, m.slip, "ppp_satellite_t.slip");
}

void convert(auto copy, Is<PppState> auto& state, auto& m) {
  copy.header(state, m.header);
  copy.choice(state.status, m.status, "ppp_state_t.status");
  copy(state.message, m.message);
  copy.place(state.position, m.latitude, m.longitude, m.height);
  copy(state.position_covariance, m.position_covariance);
  copy(state.velocity_enu, m.velocity_enu);
  copy(state.velocity_covariance, m.velocity_covariance);
  copy(state.protection.along, m.protection_along);
  copy(state.protection.across, m.protection_across);
  copy(state.protection.up, m.protection_up);
  copy(state.integrity_risk, m.integrity_risk);
  copy(state.zenith_delay, m.zenith_delay);
  copy(state.zenith_delay_sigma, m.zenith_delay_sigma);
  copy(state.code_rms, m.code_rms);
  copy(state.phase_rms, m.phase_rms);
  copy(state.converging_for, m.converging_for);
  copy(state.restarts, m.restarts);
  copy.choice(state.map, m.map, "ppp_state_t.map");
  copy(state.roads_used, m.roads_used);
  copy(state.roads_refused, m.roads_refused);
  copy(state.satellites_used, m.satellites_used);
  copy(state.satellites_corrected, m.satellites_corrected);
  copy.optional(state.correction_age, m.correction_age);
  copy.each(state.satellites, m.satellites, m.satellite_count);
}
MAPLOOP_CONVERSIONS(PppState, maploop_lcm::ppp_state_t)

}  // namespace maploop
