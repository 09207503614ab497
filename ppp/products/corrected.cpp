#include "ppp/products/corrected.h"

#include <algorithm>
#include <cmath>

namespace maploop::ppp {

void CorrectedEphemeris::add(const SsrUpdate& u) {
  Corrections& c = corrections_[u.satellite.slot()];
  const auto part = [&](auto value) {
    return SsrPart<decltype(value)>{value, u.time, u.interval, u.solution, u.issue};
  };
  if (u.orbit) {
    const bool replaces =
        c.orbit && c.orbit->value.issue == u.orbit->issue && c.orbit->same_solution(u);
    if (!replaces) c.orbit_before = c.orbit;
    c.orbit = part(*u.orbit);
  }
  if (u.clock) {
    c.clock = part(*u.clock);
    newest_ = newest_ ? std::max(*newest_, u.time) : u.time;
  }
  if (u.high_rate_clock) c.high_rate = part(*u.high_rate_clock);
  if (u.sigma) c.sigma = *u.sigma;
  if (u.has_biases) c.biases = u.biases;
  if (u.has_phase_biases) c.phase_biases = u.phase_biases;
}

template <class Value>
bool CorrectedEphemeris::fresh(const std::optional<SsrPart<Value>>& part) const {
  return part && std::chrono::abs(now_ - part->time) <= part->interval / 2 + longest_age;
}

void CorrectedEphemeris::begin(GpsTime t) {
  constexpr int enough = 4;
  now_ = t;
  for (int s = 0; s < system_count; ++s) {
    int count = 0;
    for (std::uint8_t n = 1; n < 100; ++n) {
      count += available({static_cast<System>(s), n}).has_value();
    }
    used_[static_cast<std::size_t>(s)] = count >= enough;
  }
}

std::optional<CorrectedEphemeris::Current> CorrectedEphemeris::current(Satellite satellite) const {
  if (!used_[static_cast<std::size_t>(satellite.system)]) return {};
  return available(satellite);
}

std::string CorrectedEphemeris::missing(Satellite satellite, GpsTime t) const {
  if (!used_[static_cast<std::size_t>(satellite.system)] || corrected(satellite)) {
    return broadcast_.missing(satellite, t);
  }
  return "no correction for " + to_string(satellite) + " at " + format_gps_time(t);
}

std::optional<CorrectedEphemeris::Current> CorrectedEphemeris::available(
    Satellite satellite) const {
  const Corrections& c = corrections_[satellite.slot()];
  if (!fresh(c.clock)) return {};
  for (const auto* orbit : {&c.orbit, &c.orbit_before}) {
    if (fresh(*orbit) && (*orbit)->same_solution(*c.clock) &&
        broadcast_.has_issue(satellite, (*orbit)->value.issue, now_)) {
      return Current{&**orbit, &c};
    }
  }
  return {};
}

std::optional<SatelliteState> CorrectedEphemeris::at(Satellite satellite, GpsTime t) const {
  const auto current_one = current(satellite);
  if (!current_one) {
    if (used_[static_cast<std::size_t>(satellite.system)]) return {};
    return broadcast_.at(satellite, t);
  }
  const SsrPart<SsrOrbit>& orbit = *current_one->orbit;
  const Corrections& c = *current_one->all;
  auto state = broadcast_.at_issue(satellite, orbit.value.issue, t);
  if (!state) return {};
  const Eigen::Vector3d offset =
      orbit.value.offset + to_seconds(t - orbit.time) * orbit.value.offset_rate;
  const Eigen::Vector3d along = state->velocity.normalized();
  const Eigen::Vector3d across = state->position.cross(state->velocity).normalized();
  const Eigen::Vector3d radial = along.cross(across);
  // (5) of METHOD.md
  state->position -= radial * offset.x() + along * offset.y() + across * offset.z();
  const double dt = to_seconds(t - c.clock->time);
  const auto& p = c.clock->value.polynomial;
  double clock = p[0] + p[1] * dt + p[2] * dt * dt;  // (6) of METHOD.md
  if (fresh(c.high_rate) && c.high_rate->same_solution(*c.clock)) clock += c.high_rate->value;
  state->clock += clock / speed_of_light;
  state->clock_drift += (p[1] + 2.0 * p[2] * dt) / speed_of_light;
  state->sigma = c.sigma;
  state->source = 1 + orbit.solution;
  for (const SsrPhaseBias& bias : c.phase_biases)
    state->phase_jumps += static_cast<std::uint32_t>(bias.discontinuity);
  return state;
}

std::optional<double> CorrectedEphemeris::clock(Satellite satellite, GpsTime t) const {
  return broadcast_.clock(satellite, t);
}

double CorrectedEphemeris::code_bias(Satellite satellite, char band, char attribute,
                                     GpsTime t) const {
  const auto current_one = current(satellite);
  if (current_one && !current_one->all->biases.empty()) {
    for (const SsrBias& b : current_one->all->biases) {
      if (b.band == band && b.attribute == attribute) return -b.value;
    }
    return 0.0;
  }
  return broadcast_.code_bias(satellite, band, attribute, t);
}

std::optional<double> CorrectedEphemeris::phase_bias(Satellite satellite, char band, char attribute,
                                                     GpsTime) const {
  const auto current_one = current(satellite);
  if (!current_one) return {};
  for (const SsrPhaseBias& b : current_one->all->phase_biases) {
    if (b.integer && b.band == band && b.attribute == attribute) return -b.value;
  }
  return {};
}

double CorrectedEphemeris::error_walk(Satellite satellite) const {
  constexpr double of_corrected = 3e-4;  // m/sqrt(s)
  return corrected(satellite) ? of_corrected : broadcast_.error_walk(satellite);
}

std::optional<Duration> CorrectedEphemeris::age() const {
  if (!newest_) return {};
  return std::max(Duration::zero(), now_ - *newest_);
}

}  // namespace maploop::ppp
