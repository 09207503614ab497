#include "ppp/filter/satellite_tracker.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

constexpr double longest_single = 60.0;  // s, in place of `longest_pause` with one carrier

// Each code after a satellite's first has only (1 - r) / (1 + r) of the full weight: its error is a
// first-order Gauss-Markov process with the correlation r since the previous code, `since` s ago.
void weigh_later_errors(Tracked& tracked, double since, double speed,
                        const PppParameters& parameters) {
  // (14) of METHOD.md
  const auto inflation = [since](double rate) { return 1.0 / std::tanh(0.5 * since * rate); };
  if (parameters.phase_correlation > 0.0)
    tracked.phase_inflation = inflation(1.0 / parameters.phase_correlation);
  if (tracked.measurement.satellite.system == System::glonass) {
    tracked.code_inflation = inflation(1.0 / parameters.glonass_code_correlation);
  } else if (parameters.code_correlation > 0.0) {
    tracked.code_inflation =
        inflation(1.0 / parameters.code_correlation + speed / parameters.code_correlation_distance);
  }
}

// The ambiguity has absorbed the errors of the old source.
void open_ambiguity(FilterState& state, Satellite satellite, double sigma) {
  const int at = state.find(satellite, Part::ambiguity);
  if (at >= 0) state.P()(at, at) += sigma * sigma;
}

// Adds the states of the satellite's ionosphere and of its orbit and clock, or predicts the latter
// over `since` s. Returns false if there is no room.
bool set_range_states(FilterState& state, const Tracked& tracked, GpsTime t, double since,
                      bool new_message, const Ephemeris& ephemeris,
                      const PppParameters& parameters) {
  const Satellite satellite = tracked.measurement.satellite;
  const PredictedRange& p = tracked.predicted;
  if (state.find(satellite, Part::ionosphere) < 0) {
    const double own = parameters.slant_ionosphere_share * p.ionosphere.sigma;
    const std::optional<double> bias = ephemeris.ionosphere_bias(satellite, t);
    const double sigma = std::hypot(own, bias ? 0.0 : parameters.unknown_bias_sigma);
    if (state.add(satellite, Part::ionosphere, bias.value_or(0.0), sigma) < 0) return false;
  }
  // Corrections of a stream are renewed all the time: what is left of the error is noise.
  if (p.satellite.source != 0) {
    state.remove(satellite, Part::range_error);
    return true;
  }
  const double sigma = p.satellite.sigma;
  const int error = state.find(satellite, Part::range_error);
  if (error < 0) return sigma == 0.0 || state.add(satellite, Part::range_error, 0.0, sigma) >= 0;
  state.forget(error, std::exp(-since / parameters.range_error_time), sigma * sigma);
  if (new_message) state.set(error, state.x()[error], sigma);
  return true;
}

}  // namespace

std::vector<Tracked>& SatelliteTracker::track(const std::vector<Measurement>& measured, GpsTime t,
                                              double interval, const RangeModel& model,
                                              const CodeLevels& levels,
                                              const PppParameters& parameters, FilterState& state,
                                              std::vector<SatelliteReport>& reports) {
  const double speed = state.x().segment<3>(S::velocity).norm();
  tracked_.clear();
  phase_steps_.clear();
  tracked_.reserve(usual_satellites);
  phase_steps_.reserve(usual_satellites);
  pass(interval, parameters);
  for (const Measurement& m : measured) {
    SatelliteReport& report = reports[m.report];
    Memory& memory = memory_[m.satellite.slot()];
    const auto predicted = model.predict(m, memory.wind_up);
    if (!predicted) {
      report.refused = PppRefusal::no_ephemeris;
      continue;
    }
    report.azimuth = predicted->azimuth;
    report.elevation = predicted->elevation;
    if (predicted->elevation < radians(parameters.elevation_mask)) {
      report.refused = PppRefusal::low;
      continue;
    }
    Tracked tracked{m, *predicted};
    tracked.code_offset = m.code(Combination::range) - predicted->code(m, Combination::range);
    tracked.level = levels.of(m.satellite);
    double since = 0.0;
    tracked.first_code = !memory.last_code;
    if (memory.last_code) {
      since = std::abs(to_seconds(t - *memory.last_code));
      weigh_later_errors(tracked, since, speed, parameters);
      tracked.new_source = memory.source != predicted->satellite.source;
    }
    if (tracked.new_source) open_ambiguity(state, m.satellite, parameters.source_change_sigma);
    if (memory.integer != m.integer || memory.phase_jumps != predicted->satellite.phase_jumps)
      state.remove_ambiguities(m.satellite);  // its phases have other biases than before
    if (memory.last_code) bridge_ionosphere(tracked, memory, state);
    const bool new_message = memory.message != predicted->satellite.message;
    if (!set_range_states(state, tracked, t, since, new_message, model.ephemeris(), parameters)) {
      report.refused = PppRefusal::too_many;
      continue;
    }
    memory.source = predicted->satellite.source;
    memory.integer = m.integer;
    memory.phase_jumps = predicted->satellite.phase_jumps;
    memory.ionosphere = predicted->ionosphere;
    memory.last_code = t;
    tracked.phase_good = m.has_phase();
    if (tracked.phase_good) {
      report.slip = look_for_slip(tracked, interval, parameters, state);
    } else {
      report.refused = PppRefusal::no_phase;
    }
    tracked_.push_back(tracked);
  }
  find_slips(phase_steps_);
  for (const PhaseStep& step : phase_steps_) {
    if (!step.slipped) continue;
    const Measurement& m = tracked_[step.tracked].measurement;
    reports[m.report].slip = PppSlip::phase_step;
    state.remove_ambiguities(m.satellite);
  }
  return tracked_;
}

// All epochs may have been missing. A receiver that has gone on meanwhile states a loss of lock,
// but not all do, and over a long pause nothing else tells the slips of one carrier.
void SatelliteTracker::pass(double interval, const PppParameters& parameters) {
  const double pause = std::abs(interval), longest = parameters.longest_pause;
  for (Memory& memory : memory_) {
    const bool too_long = pause > (memory.dual ? longest : std::min(longest, longest_single));
    memory.phase_lost |= too_long;
    ++memory.epochs_away;
  }
}

// Where the model's delay comes from another source than before, the satellite's own delay takes up
// the difference: what was estimated goes on.
void SatelliteTracker::bridge_ionosphere(const Tracked& tracked, Memory& memory,
                                         FilterState& state) {
  const IonosphericDelay& now = tracked.predicted.ionosphere;
  if (memory.ionosphere.source == now.source) return;
  const double step = now.value - memory.ionosphere.value;
  const int own = state.find(tracked.measurement.satellite, Part::ionosphere);
  if (own < 0) return;
  state.x()[own] -= step;
  memory.phase_less_range += tracked.measurement.ionosphere(Combination::range) * step;
}

PppSlip SatelliteTracker::look_for_slip(const Tracked& tracked, double interval,
                                        const PppParameters& parameters, FilterState& state) {
  const Measurement& m = tracked.measurement;
  const PredictedRange& p = tracked.predicted;
  Memory& memory = memory_[m.satellite.slot()];
  const double since = interval * std::max(1, memory.epochs_away);
  const bool away_for_long = memory.phase_lost || memory.epochs_away > parameters.longest_gap;
  const bool other_carriers = memory.dual != m.dual();
  if (away_for_long || other_carriers) memory.slips.reset();
  memory.dual = m.dual();
  const PppSlip slip = memory.slips.next(m, since, p.elevation, parameters);
  if (slip != PppSlip::none || away_for_long || other_carriers)
    state.remove_ambiguities(m.satellite);
  const double phase_less_range = m.phase(Combination::range) - p.phase(m, Combination::range);
  const bool goes_on = memory.epochs_away == 1 && memory.message == p.satellite.message &&
                       !away_for_long && !other_carriers;
  if (goes_on && slip == PppSlip::none && !m.dual() && interval != 0.0) {
    const double limit = slip_limit(parameters.slip_phase_step, interval, p.elevation, parameters);
    phase_steps_.push_back({tracked_.size(), p.to_satellite,
                            phase_less_range - memory.phase_less_range, limit, false});
  }
  memory.message = p.satellite.message;
  memory.phase_less_range = phase_less_range;
  memory.epochs_away = 0;
  memory.phase_lost = false;
  return slip;
}

void SatelliteTracker::forget_absent(int longest_gap, FilterState& state) const {
  for (std::size_t i = state.entries().size(); i-- > 0;) {
    const auto [satellite, part] = state.entries()[i];
    if (memory_[satellite.slot()].epochs_away > longest_gap) state.remove(satellite, part);
  }
}

}  // namespace maploop::ppp
