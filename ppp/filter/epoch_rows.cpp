#include "ppp/filter/epoch_rows.h"

#include <algorithm>
#include <cmath>

#include "ppp/filter/lasting_error.h"
#include "ppp/filter/median.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

// Returns the receiver's clock drift according to one Doppler, m/s.
double drift_of(const Tracked& t, const FilterState& state) {
  const auto& c = t.measurement.first;
  const auto& p = t.predicted;
  const Eigen::Vector3d& s = p.satellite.position;
  const Eigen::Vector3d r = state.x().segment<3>(S::position);
  const Eigen::Vector3d velocity = state.x().segment<3>(S::velocity);
  const double sagnac = earth_rotation_rate / speed_of_light *
                        (p.satellite.velocity.y() * r.x() + s.y() * velocity.x() -
                         p.satellite.velocity.x() * r.y() - s.x() * velocity.y());
  const double rate = p.to_satellite.dot(p.satellite.velocity - velocity) - sagnac -
                      speed_of_light * p.satellite.clock_drift;
  return -c.doppler * c.wavelength - rate;
}

bool has_doppler(const Tracked& t) {
  return t.code_good && t.measurement.first.doppler != 0.0;
}

// Returns the variance relative to that at the zenith. It grows towards low elevations, and where
// the signal is weaker than an unobstructed one, as in the SIGMA-delta model (Brunner, Hartinger
// and Troyer, "GPS signal diffraction modelling", Journal of Geodesy 73, 1999).
double variance_factor(const Tracked& t, const UnobstructedCn0& strength) {
  const double sine = std::sin(t.predicted.elevation), cn0 = t.measurement.first.cn0;
  const double missing = cn0 > 0.0 ? std::max(0.0, strength.of(sine) - cn0) : 0.0;
  constexpr double sigma_delta = 2.0;  // their factor on the missing strength
  return std::pow(10.0, sigma_delta * missing / 10.0) / (sine * sine);  // (10) of METHOD.md
}

}  // namespace

std::vector<Row>& EpochRows::make(const std::vector<Tracked>& tracked, int reference_system,
                                  const UnobstructedCn0& strength, FilterState& state,
                                  std::vector<SatelliteReport>& reports) {
  rows_.clear();
  const bool use_doppler = parameters_.motion == Motion::kinematic;
  if (use_doppler) set_drift(tracked, state);
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    const Tracked& t = tracked[i];
    if (!t.code_good) continue;
    const double factor = variance_factor(t, strength);
    const Row code = code_row(i, t, factor, reference_system, state);
    rows_.push_back(code);
    if (t.phase_good) add_phase_row(t, factor, code, state, reports);
    if (!use_doppler || !has_doppler(t)) continue;
    Row doppler;
    doppler.kind = RowKind::doppler;
    doppler.tracked = i;
    doppler.y = drift_of(t, state) - state.x()[S::clock_drift];  // (9) of METHOD.md
    for (int k = 0; k < 3; ++k) doppler.add(S::velocity + k, -t.predicted.to_satellite[k]);
    doppler.add(S::clock_drift, 1.0);
    const double sigma = parameters_.doppler_sigma;
    doppler.variance = sigma * sigma * factor * t.level;  // (13) of METHOD.md
    doppler.sigma = std::sqrt(doppler.variance);
    rows_.push_back(doppler);
  }
  return rows_;
}

void EpochRows::set_drift(const std::vector<Tracked>& tracked, FilterState& state) {
  drifts_.clear();
  for (const Tracked& t : tracked) {
    if (has_doppler(t)) drifts_.push_back(drift_of(t, state));
  }
  state.set(S::clock_drift, drifts_.empty() ? 0.0 : median(drifts_), parameters_.drift_sigma);
}

Row EpochRows::code_row(std::size_t i, const Tracked& t, double factor, int reference_system,
                        const FilterState& state) const {
  const Measurement& m = t.measurement;
  const int system = static_cast<int>(m.satellite.system);
  Row row;
  row.kind = RowKind::code;
  row.tracked = i;
  for (int k = 0; k < 3; ++k) row.add(S::position + k, -t.predicted.to_satellite[k]);
  row.add(S::clock, 1.0);
  if (system != reference_system) row.add(S::system_offset + system, 1.0);
  row.add(S::zenith_wet, t.predicted.wet_mapping);
  if (parameters_.gradients) {
    const double slope = t.predicted.wet_mapping / std::tan(t.predicted.elevation);
    row.add(S::gradient_north, slope * std::cos(t.predicted.azimuth));
    row.add(S::gradient_east, slope * std::sin(t.predicted.azimuth));
  }
  // This is what the state predicts besides the geometric range, which is already computed at the
  // state's own position.
  double predicted = 0.0;
  for (std::size_t k = 3; k < static_cast<std::size_t>(row.count); ++k) {
    predicted += row.h[k] * state.x()[row.indices[k]];
  }
  const double glonass =
      m.satellite.system == System::glonass ? parameters_.glonass_code_factor : 1.0;
  const double sigma = parameters_.code_sigma * m.noise_factor() * glonass;
  const double sine = std::sin(t.predicted.elevation);
  const double direct = sigma * sigma / (sine * sine), all = sigma * sigma * factor * t.level;
  const double rest = lasting_variance(t.predicted);
  // (11) of METHOD.md
  row.variance = all * t.code_inflation + rest;
  row.sigma = std::sqrt(all + rest);
  row.delay = std::sqrt(std::max(0.0, all - direct) / 2.0);
  row.y = t.code_offset - predicted - row.delay;  // (7) of METHOD.md
  return row;
}

// Adds the row of the phase, or on one frequency of GRAPHIC: half the sum of code and phase is free
// of the ionosphere and contains half the ambiguity (here a separate state, in metres).
void EpochRows::add_phase_row(const Tracked& t, double factor, const Row& code, FilterState& state,
                              std::vector<SatelliteReport>& reports) {
  const Measurement& m = t.measurement;
  const bool graphic = !m.dual() && parameters_.graphic;
  const double phase = m.phase() - t.predicted.phase_extra - t.predicted.range;
  constexpr double code_share = 0.5;  // the sum of code and phase is half of both
  // (2) of METHOD.md
  const double y = graphic ? code_share * (phase + m.code() - code.delay - t.predicted.range)
                           : phase + t.predicted.ionosphere.value;
  const double predicted = t.code_offset - code.y - code.delay;  // clocks, wet delay, gradients
  int index = state.ambiguity(m.satellite);
  const bool is_new = index < 0;
  if (is_new) {
    index = state.add_ambiguity(m.satellite, y - predicted, parameters_.ambiguity_sigma);
    if (index < 0) {
      reports[m.report].refused = PppRefusal::too_many;
      return;
    }
  }
  Row row = code;
  row.kind = RowKind::phase;
  row.new_ambiguity = is_new;
  row.add(index, 1.0);
  row.y = y - predicted - state.x()[index];  // (8) of METHOD.md
  const double sigma = parameters_.phase_sigma * m.noise_factor();
  const double shadow = t.predicted.in_shadow ? parameters_.shadow_phase_factor : 1.0;
  // (12) of METHOD.md
  row.variance = sigma * sigma * factor * t.level * (shadow * shadow);
  row.sigma = std::sqrt(row.variance);
  if (graphic) {
    row.variance += code_share * code_share * code.variance;
    row.sigma = std::hypot(row.sigma, code_share * code.sigma);
  }
  rows_.push_back(row);
}

}  // namespace maploop::ppp
