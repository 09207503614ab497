#include "ppp/filter/epoch_rows.h"

#include <algorithm>
#include <cmath>

#include "msgs/median.h"
#include "ppp/filter/row_update.h"

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

// Returns how much weaker the signal is than an unobstructed one, dB.
double missing_strength(const Tracked& t, const UnobstructedCn0& strength) {
  const double cn0 = t.measurement.first.cn0;
  if (cn0 == 0.0) return 0.0;
  return std::max(0.0, strength.of(std::sin(t.predicted.elevation)) - cn0);
}

// Returns the variance relative to that at the zenith. It grows towards low elevations, and where
// the signal is too weak, as in the SIGMA-delta model (Brunner, Hartinger and Troyer, "GPS signal
// diffraction modelling", Journal of Geodesy 73, 1999).
double variance_factor(const Tracked& t, double missing) {
  const double sine = std::sin(t.predicted.elevation);
  constexpr double sigma_delta = 2.0;  // their factor on the missing strength
  return std::pow(10.0, sigma_delta * missing / 10.0) / (sine * sine);  // (10) of METHOD.md
}

// Returns the share of a signal's power that obstacles have taken: it was diffracted or reflected.
double obstructed_share(double missing) {
  return 1.0 - std::pow(10.0, -missing / 10.0);
}

// Adds the entries of the ionosphere's delay, of which `share` is that on GPS L1.
void add_ionosphere(LinearRow& row, const Tracked& t, double share, const FilterState& state) {
  const PredictedRange& p = t.predicted;
  const double slant = share * p.ionosphere_slant;
  row.add(S::zenith_ionosphere, slant);
  row.add(S::ionosphere_north, slant * p.ionosphere_distance * std::cos(p.azimuth));
  row.add(S::ionosphere_east, slant * p.ionosphere_distance * std::sin(p.azimuth));
  row.add(state.find(t.measurement.satellite, Part::ionosphere), share);
}

}  // namespace

double ionosphere_of(const Tracked& t, const FilterState& state) {
  LinearRow row;
  add_ionosphere(row, t, 1.0, state);
  return t.predicted.ionosphere.value + value_of(state, row);
}

std::vector<Row>& EpochRows::make(const std::vector<Tracked>& tracked, int reference_system,
                                  const UnobstructedCn0& strength, FilterState& state,
                                  std::vector<SatelliteReport>& reports) {
  rows_.clear();
  rows_.reserve(5 * usual_satellites);  // codes and phases of two carriers, Doppler
  const bool use_doppler = parameters_.motion == Motion::kinematic;
  if (use_doppler) set_drift(tracked, state);
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    const Tracked& t = tracked[i];
    if (!t.code_good) continue;
    const double missing = missing_strength(t, strength);
    const double factor = variance_factor(t, missing);
    for (const Combination c : {Combination::range, Combination::ionosphere}) {
      if (c == Combination::ionosphere && !t.measurement.dual()) continue;
      rows_.push_back(code_row(i, t, c, factor, missing, reference_system, state));
      if (t.phase_good) add_phase_row(i, t, c, factor, missing, reference_system, state, reports);
    }
    if (use_doppler && has_doppler(t)) rows_.push_back(doppler_row(i, t, factor, missing, state));
  }
  return rows_;
}

void EpochRows::set_drift(const std::vector<Tracked>& tracked, FilterState& state) {
  drifts_.clear();
  drifts_.reserve(usual_satellites);
  for (const Tracked& t : tracked) {
    if (has_doppler(t)) drifts_.push_back(drift_of(t, state));
  }
  state.set(S::clock_drift, drifts_.empty() ? 0.0 : median(drifts_), parameters_.drift_sigma);
}

// Makes the row of a code (`sign` 1), which the ionosphere delays, or of a phase (-1), which it
// advances; y lacks what was measured.
Row EpochRows::range_row(std::size_t i, const Tracked& t, Combination c, double sign,
                         int reference_system, const FilterState& state) const {
  const Measurement& m = t.measurement;
  const PredictedRange& p = t.predicted;
  const int system = static_cast<int>(m.satellite.system);
  Row row;
  row.tracked = i;
  row.combination = c;
  if (c == Combination::range) {
    for (int k = 0; k < 3; ++k) row.add(S::position + k, -p.to_satellite[k]);
    row.add(S::clock, 1.0);
    if (system != reference_system) row.add(S::system_offset + system, 1.0);
    row.add(S::zenith_wet, p.wet_mapping);
    if (parameters_.gradients) {
      const double slope = p.wet_mapping / std::tan(p.elevation);
      row.add(S::gradient_north, slope * std::cos(p.azimuth));
      row.add(S::gradient_east, slope * std::sin(p.azimuth));
    }
    if (const int error = state.find(m.satellite, Part::range_error); error >= 0)
      row.add(error, 1.0);
  }
  add_ionosphere(row, t, sign * m.ionosphere(c), state);
  if (sign > 0.0 && c == Combination::ionosphere) row.add(S::code_difference + system, 1.0);
  // This is what the state predicts besides the geometric range, which is already computed at the
  // state's own position.
  const double predicted = value_of(state, row, c == Combination::range ? 3 : 0);
  row.y = -predicted - (sign > 0.0 ? p.code(m, c) : p.phase(m, c));
  return row;
}

Row EpochRows::code_row(std::size_t i, const Tracked& t, Combination c, double factor,
                        double missing, int reference_system, FilterState& state) const {
  const Measurement& m = t.measurement;
  const int difference = S::code_difference + static_cast<int>(m.satellite.system);
  if (c == Combination::ionosphere && state.P()(difference, difference) == 0.0)
    state.set(difference, 0.0, parameters_.code_difference_sigma);
  Row row = range_row(i, t, c, 1.0, reference_system, state);
  row.kind = RowKind::code;
  const double glonass =
      m.satellite.system == System::glonass ? parameters_.glonass_code_factor : 1.0;
  const double sigma = m.sigma(c, parameters_.code_sigma, parameters_.common_code_sigma) * glonass;
  const double sine = std::sin(t.predicted.elevation);
  const double direct = sigma * sigma / (sine * sine), all = sigma * sigma * factor * t.level;
  const bool range = c == Combination::range;
  const bool noisy_orbit = range && state.find(m.satellite, Part::range_error) < 0;
  const double noise = noisy_orbit ? t.predicted.satellite.sigma : 0.0;
  const double first =
      t.first_code ? std::lerp(1.0, parameters_.first_code_factor, obstructed_share(missing)) : 1.0;
  row.variance = all * t.code_inflation * first + noise * noise;  // (11) of METHOD.md
  row.most_sigmas = parameters_.outlier_sigmas;
  row.sigma = std::sqrt(all + noise * noise);
  if (range) row.delay = 0.5 * std::sqrt(std::max(0.0, all - direct));
  row.y += m.code(c) - row.delay;  // (7) of METHOD.md
  return row;
}

Row EpochRows::doppler_row(std::size_t i, const Tracked& t, double factor, double missing,
                           const FilterState& state) const {
  Row row;
  row.kind = RowKind::doppler;
  row.tracked = i;
  row.y = drift_of(t, state) - state.x()[S::clock_drift];  // (9) of METHOD.md
  for (int k = 0; k < 3; ++k) row.add(S::velocity + k, -t.predicted.to_satellite[k]);
  row.add(S::clock_drift, 1.0);
  const double noise = parameters_.doppler_sigma;
  const double reflected = parameters_.reflected_doppler * state.x().segment<3>(S::velocity).norm();
  row.variance = noise * noise * factor * t.level +
                 reflected * reflected * obstructed_share(missing);  // (13) of METHOD.md
  row.sigma = std::sqrt(row.variance);
  row.most_sigmas = most_sigmas(missing);
  return row;
}

// Phases and Dopplers of obstructed signals are judged more strictly.
double EpochRows::most_sigmas(double missing) const {
  return std::lerp(parameters_.outlier_sigmas, parameters_.obstructed_outlier_sigmas,
                   obstructed_share(missing));
}

void EpochRows::add_phase_row(std::size_t i, const Tracked& t, Combination c, double factor,
                              double missing, int reference_system, FilterState& state,
                              std::vector<SatelliteReport>& reports) {
  const Measurement& m = t.measurement;
  Row row = range_row(i, t, c, -1.0, reference_system, state);
  row.kind = RowKind::phase;
  row.y += m.phase(c);
  const Part part = c == Combination::range ? Part::ambiguity : Part::ionosphere_ambiguity;
  int index = state.find(m.satellite, part);
  row.new_ambiguity = index < 0;
  if (row.new_ambiguity) {
    index = state.add(m.satellite, part, row.y, parameters_.ambiguity_sigma);
    if (index < 0) {
      reports[m.report].refused = PppRefusal::too_many;
      return;
    }
  }
  row.add(index, 1.0);
  row.y -= state.x()[index];  // (8) of METHOD.md
  const double shadow = t.predicted.in_shadow ? parameters_.shadow_phase_factor : 1.0;
  const auto sigma = [&](double inflation) {
    const double common = parameters_.common_phase_sigma * std::sqrt(inflation);
    return m.sigma(c, parameters_.phase_sigma, common) * shadow * std::sqrt(factor * t.level);
  };
  const double inflated = sigma(t.phase_inflation);
  row.sigma = sigma(1.0);
  row.variance = inflated * inflated;  // (12) of METHOD.md
  row.most_sigmas = most_sigmas(missing);
  rows_.push_back(row);
}

}  // namespace maploop::ppp
