#include "ppp/filter/satellite_tracker.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

// A satellite's first code has its full weight, each later one only (1 - r) / (1 + r) of it: its
// error is a first-order Gauss-Markov process with the correlation r since the previous code,
// `since` s ago.
void weigh_later_code(Tracked& tracked, double since, double speed,
                      const PppParameters& parameters) {
  // (14) of METHOD.md
  const auto inflation = [since](double rate) { return 1.0 / std::tanh(0.5 * since * rate); };
  if (tracked.measurement.satellite.system == System::glonass) {
    tracked.code_inflation = inflation(1.0 / parameters.glonass_code_correlation);
  } else if (parameters.code_correlation > 0.0) {
    tracked.code_inflation =
        inflation(1.0 / parameters.code_correlation + speed / parameters.code_correlation_distance);
  }
}

// The ambiguity has absorbed the errors of the old source.
void open_ambiguity(FilterState& state, Satellite satellite, double sigma) {
  if (const int at = state.ambiguity(satellite); at >= 0) state.P()(at, at) += sigma * sigma;
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
  for (Memory& memory : memory_) ++memory.epochs_away;
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
    tracked.code_offset = m.code() - predicted->range - predicted->ionosphere.value;
    tracked.level = levels.of(m.satellite);
    if (memory.last_code) {
      weigh_later_code(tracked, to_seconds(t - *memory.last_code), speed, parameters);
      tracked.new_source = memory.source != predicted->satellite.source;
    }
    if (tracked.new_source) open_ambiguity(state, m.satellite, parameters.source_change_sigma);
    memory.source = predicted->satellite.source;
    memory.last_code = t;
    tracked.phase_good = m.phase() != 0.0;
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
    state.remove_ambiguity(m.satellite);
  }
  return tracked_;
}

PppSlip SatelliteTracker::look_for_slip(const Tracked& tracked, double interval,
                                        const PppParameters& parameters, FilterState& state) {
  const Measurement& m = tracked.measurement;
  const PredictedRange& p = tracked.predicted;
  Memory& memory = memory_[m.satellite.slot()];
  const double since = interval * std::max(1, memory.epochs_away);
  const bool away_for_long = memory.epochs_away > parameters.longest_gap;
  if (away_for_long) memory.slips.reset();
  const PppSlip slip = memory.slips.next(m, since, p.elevation, parameters);
  if (slip != PppSlip::none || away_for_long) state.remove_ambiguity(m.satellite);
  const double phase_less_range = m.phase() - p.phase_extra - p.range;
  const bool goes_on = memory.epochs_away == 1 && memory.message == p.satellite.message;
  if (goes_on && slip == PppSlip::none && !m.dual() && interval > 0.0) {
    const double limit = slip_limit(parameters.slip_phase_step, interval, p.elevation, parameters);
    phase_steps_.push_back({tracked_.size(), p.to_satellite,
                            phase_less_range - memory.phase_less_range, limit, false});
  }
  memory.message = p.satellite.message;
  memory.phase_less_range = phase_less_range;
  memory.epochs_away = 0;
  return slip;
}

void SatelliteTracker::forget_absent(int longest_gap, FilterState& state) const {
  for (std::size_t i = state.ambiguities().size(); i-- > 0;) {
    const Satellite satellite = state.ambiguities()[i];
    if (memory_[satellite.slot()].epochs_away > longest_gap) state.remove_ambiguity(satellite);
  }
}

}  // namespace maploop::ppp
