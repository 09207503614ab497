#include "ppp/filter/ppp_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "msgs/frames.h"
#include "ppp/filter/median.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

}  // namespace

PppFilter::PppFilter(const PppParameters& parameters, const RangeInputs& inputs, Earth earth)
    : parameters_(parameters),
      model_(inputs, std::move(earth)),
      memory_(satellite_slots),
      unobstructed_cn0_(parameters),
      rows_(parameters),
      map_dx_(FilterState::capacity),
      update_(parameters.outlier_sigmas) {}

void PppFilter::reset() {
  state_.clear();
  std::fill(memory_.begin(), memory_.end(), Memory{});
  levels_.begin(1.0);
  started_ = false;
  reference_system_ = -1;
  has_offset_.fill(false);
  bad_epochs_ = 0;
  restarts_ = 0;
  has_map_ = false;
  lasting_.setZero();
  unmodelled_ionosphere_shift_.setZero();
  solution_.status = PppStatus::none;
}

MapUse PppFilter::add(const MapFeedback& feedback) {
  if (solution_.status == PppStatus::none) return MapUse::no_position;
  const double since = to_seconds(feedback.stamp - to_utc(time_));
  if (!(std::abs(since) <= parameters_.map_reach)) return MapUse::not_of_this_epoch;
  const MapUse use = apply_map(state_, feedback, since, level_covariance(), parameters_, map_dx_);
  has_map_ |= use == MapUse::used;
  return use;
}

const PppSolution& PppFilter::process(const Epoch& epoch) {
  const double interval = started_ ? to_seconds(epoch.time - time_) : 0.0;
  std::vector<SatelliteReport> reports = std::move(solution_.satellites);  // reuses its memory
  reports.clear();
  solution_ = {};
  solution_.satellites = std::move(reports);
  solution_.time = epoch.time;
  solution_.restarts = restarts_;
  measure_all(epoch);
  clock_steps_.repair(measurements_);
  if (!started_ && !start(epoch)) return solution_;
  if (interval > 0.0) predict(interval);
  time_ = epoch.time;
  model_.begin(time_, state_.x().segment<3>(S::position));
  predict_ranges(interval);
  set_clocks();
  weigh_lasting_errors();
  disagrees_ = false;
  update();
  levels_.end_epoch(interval > 0.0 ? interval : 1.0, parameters_.code_level_time);
  forget_absent();

  bad_epochs_ = disagrees_ ? bad_epochs_ + 1 : 0;
  report();
  constexpr int patience = 5;  // epochs
  if (bad_epochs_ >= patience) {
    const std::uint64_t restarts = restarts_ + 1;
    reset();
    restarts_ = restarts;
    solution_.restarts = restarts_;
    solution_.status = PppStatus::none;
    solution_.message = "started again: for 5 epochs measurements have disagreed with the position";
  }
  return solution_;
}

// Selects carriers, and adds a report for every satellite of the epoch.
void PppFilter::measure_all(const Epoch& epoch) {
  measurements_.clear();
  report_of_.clear();
  for (const SatelliteSignals& s : epoch.satellites) {
    if (parameters_.systems.find(letter(s.satellite.system)) == std::string::npos) continue;
    SatelliteReport report;
    report.satellite = s.satellite;
    const auto m = measure(s.satellite, epoch.of(s), model_.inputs().glonass_channels,
                           model_.ephemeris(), epoch.time, model_.inputs().one_frequency);
    if (!m) {
      report.refused = PppRefusal::no_signals;
    } else if (m->first.cn0 > 0.0 && m->first.cn0 < parameters_.cn0_mask) {
      report.cn0 = m->first.cn0;
      report.refused = PppRefusal::weak;
    } else {
      report.cn0 = m->first.cn0;
      measurements_.push_back(*m);
      report_of_.push_back(solution_.satellites.size());
    }
    solution_.satellites.push_back(report);
  }
}

bool PppFilter::start(const Epoch& epoch) {
  const Eigen::Vector3d near = state_.x().segment<3>(S::position);
  const double sigma = std::max(1.0, parameters_.code_sigma);
  const SinglePoint point = solve_single_point(measurements_, epoch.time, near,
                                               radians(parameters_.elevation_mask), sigma, model_);
  if (!point.solved) {
    solution_.message = "no first position: " + point.failure;
    return false;
  }
  state_.clear();
  for (int i = 0; i < 3; ++i) {
    state_.set(S::position + i, point.position[i], parameters_.position_sigma);
    const bool moves = parameters_.motion == Motion::kinematic;
    state_.set(S::velocity + i, 0.0, moves ? 10.0 : 0.0);
  }
  state_.set(S::zenith_wet, 0.0, parameters_.zenith_wet_sigma);
  if (parameters_.gradients) {
    state_.set(S::gradient_north, 0.0, parameters_.gradient_sigma);
    state_.set(S::gradient_east, 0.0, parameters_.gradient_sigma);
  }
  begin_map_states(state_, Eigen::Vector2d::Zero(), parameters_);
  const double ratio = sigma / parameters_.code_sigma;
  levels_.begin(point.residual_level * ratio * ratio);
  started_ = true;
  started_at_ = epoch.time;
  return true;
}

void PppFilter::predict(double interval) {
  auto P = state_.P();
  if (parameters_.motion == Motion::kinematic) {
    // The motion model is constant velocity under white acceleration.
    auto x = state_.x();
    x.segment<3>(S::position) += interval * x.segment<3>(S::velocity);
    P.middleRows<3>(S::position) += interval * P.middleRows<3>(S::velocity);
    P.middleCols<3>(S::position) += interval * P.middleCols<3>(S::velocity);
    const Eigen::Vector3d density(parameters_.horizontal_acceleration,
                                  parameters_.horizontal_acceleration,
                                  parameters_.vertical_acceleration);
    const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(x.segment<3>(S::position)));
    const Eigen::Matrix3d Q = R.transpose() * density.asDiagonal() * R;
    const double t = interval;
    P.block<3, 3>(S::position, S::position) += Q * (t * t * t / 3.0);
    P.block<3, 3>(S::position, S::velocity) += Q * (t * t / 2.0);
    P.block<3, 3>(S::velocity, S::position) += Q * (t * t / 2.0);
    P.block<3, 3>(S::velocity, S::velocity) += Q * t;
    predict_map_states(state_, interval, lasting_, parameters_);
  }
  const auto walk = [&](int index, double density) {
    P(index, index) += density * density * interval;
  };
  walk(S::zenith_wet, parameters_.zenith_wet_walk);
  if (parameters_.gradients) {
    walk(S::gradient_north, parameters_.gradient_walk);
    walk(S::gradient_east, parameters_.gradient_walk);
  }
  for (int s = 0; s < system_count; ++s) {
    if (has_offset_[static_cast<std::size_t>(s)] && s != reference_system_) {
      walk(S::system_offset + s, parameters_.system_offset_walk);
    }
  }
  for (int i = S::fixed; i < state_.size(); ++i) {
    const Satellite satellite = state_.ambiguities()[static_cast<std::size_t>(i - S::fixed)];
    walk(i, std::hypot(parameters_.ambiguity_walk, model_.ephemeris().error_walk(satellite)));
  }
}

// A satellite's first code has its full weight, each later one only (1 - r) / (1 + r) of it: its
// error is a first-order Gauss-Markov process with the correlation r since the previous epoch.
void PppFilter::weigh_code(Tracked& tracked, const Memory& memory) const {
  const Satellite satellite = tracked.measurement.satellite;
  tracked.level = levels_.of(satellite);
  if (!memory.last_code) return;
  const double since = to_seconds(time_ - *memory.last_code);
  const double speed = state_.x().segment<3>(S::velocity).norm();
  // (14) of METHOD.md
  const auto inflation = [since](double rate) { return 1.0 / std::tanh(0.5 * since * rate); };
  tracked.level_inflation =
      inflation(1.0 / parameters_.reflection_time + speed / parameters_.reflection_distance);
  if (satellite.system == System::glonass) {
    tracked.code_inflation = inflation(1.0 / parameters_.glonass_code_correlation);
  } else if (parameters_.code_correlation > 0.0) {
    tracked.code_inflation = inflation(1.0 / parameters_.code_correlation +
                                       speed / parameters_.code_correlation_distance);
  }
}

// Predicts ranges, applies the masks and looks for slips.
void PppFilter::predict_ranges(double interval) {
  tracked_.clear();
  phase_steps_.clear();
  for (Memory& memory : memory_) ++memory.epochs_away;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    const Measurement& m = measurements_[i];
    SatelliteReport& report = solution_.satellites[report_of_[i]];
    Memory& memory = memory_[m.satellite.slot()];
    const auto predicted = model_.predict(m, memory.wind_up);
    if (!predicted) {
      report.refused = PppRefusal::no_ephemeris;
      continue;
    }
    report.azimuth = predicted->azimuth;
    report.elevation = predicted->elevation;
    if (predicted->elevation < radians(parameters_.elevation_mask)) {
      report.refused = PppRefusal::low;
      continue;
    }
    if (memory.last_code && memory.source != predicted->satellite.source)
      change_source(m.satellite);
    memory.source = predicted->satellite.source;
    Tracked tracked{m, *predicted, report_of_[i],
                    m.code() - predicted->range - predicted->ionosphere.value};
    weigh_code(tracked, memory);
    memory.last_code = time_;
    tracked.phase_good = m.phase() != 0.0;
    if (tracked.phase_good) {
      look_for_slips(tracked, memory, interval);
      memory.epochs_away = 0;
    } else {
      report.refused = PppRefusal::no_phase;
    }
    tracked_.push_back(tracked);
  }
  find_phase_step_slips();
}

// The ambiguity has absorbed the old source's errors. The new clocks count from another origin,
// which the system's offset absorbs (for the reference system, all other offsets).
void PppFilter::change_source(Satellite satellite) {
  constexpr double difference = 2.0, unknown = 100.0;  // m, of the ranges by two sources
  if (const int at = state_.ambiguity(satellite); at >= 0) {
    state_.P()(at, at) += difference * difference;
  }
  const int own = static_cast<int>(satellite.system);
  for (int s = 0; s < system_count; ++s) {
    const int offset = S::system_offset + s;
    const bool against_it = own == reference_system_ ? s != own : s == own;
    if (against_it && has_offset_[static_cast<std::size_t>(s)])
      state_.set(offset, state_.x()[offset], unknown);
  }
}

void PppFilter::look_for_slips(Tracked& tracked, Memory& memory, double interval) {
  const Measurement& m = tracked.measurement;
  const PredictedRange& p = tracked.predicted;
  const double since = interval * std::max(1, memory.epochs_away);
  const bool away_for_long = memory.epochs_away > parameters_.longest_gap;
  if (away_for_long) memory.slips.reset();
  const PppSlip slip = memory.slips.next(m, since, p.elevation);
  solution_.satellites[tracked.report].slip = slip;
  if (slip != PppSlip::none || away_for_long) state_.remove_ambiguity(m.satellite);
  const double phase_less_range = m.phase() - p.phase_extra - p.range;
  const bool goes_on = memory.epochs_away == 1 && memory.message == p.satellite.message;
  if (goes_on && slip == PppSlip::none && !m.dual() && interval > 0.0) {
    // This is a quarter of a cycle of the first carriers, plus the drift of ionosphere and clocks.
    const double limit = slip_limit(0.05, interval, p.elevation);
    phase_steps_.push_back({tracked_.size(), p.to_satellite,
                            phase_less_range - memory.phase_less_range, limit, false});
  }
  memory.message = p.satellite.message;
  memory.phase_less_range = phase_less_range;
}

void PppFilter::find_phase_step_slips() {
  find_slips(phase_steps_);
  for (const PhaseStep& step : phase_steps_) {
    if (!step.slipped) continue;
    const Tracked& t = tracked_[step.tracked];
    solution_.satellites[t.report].slip = PppSlip::phase_step;
    state_.remove_ambiguity(t.measurement.satellite);
  }
}

// Sets the receiver's clock, and the offsets of new systems, from the medians of the codes. Codes
// far from the median are refused.
void PppFilter::set_clocks() {
  const auto system_of_row = [](const Tracked& t) {
    return static_cast<std::size_t>(t.measurement.satellite.system);
  };
  const auto median_of = [&](auto&& which, auto&& value) {
    sorted_.clear();
    for (const Tracked& t : tracked_) {
      if (which(t)) sorted_.push_back(value(t));
    }
    return sorted_.empty() ? std::optional<double>{} : median(sorted_);
  };
  const auto offset = [&](const Tracked& t) {
    return state_.x()[S::system_offset + static_cast<int>(system_of_row(t))];
  };
  auto clock = median_of([&](const Tracked& t) { return has_offset_[system_of_row(t)]; },
                         [&](const Tracked& t) { return t.code_offset - offset(t); });
  constexpr double unknown = 100.0;  // m
  for (const System system : {System::gps, System::galileo, System::beidou, System::qzss,
                              System::glonass, System::sbas, System::navic}) {
    const auto s = static_cast<std::size_t>(system);
    if (has_offset_[s]) continue;
    const auto own = median_of([&](const Tracked& t) { return system_of_row(t) == s; },
                               [](const Tracked& t) { return t.code_offset; });
    if (!own) continue;
    has_offset_[s] = true;
    if (!clock) {
      clock = own;
      reference_system_ = static_cast<int>(s);
    } else {
      state_.set(S::system_offset + static_cast<int>(s), *own - *clock, unknown);
    }
  }
  if (!clock) return;
  state_.set(S::clock, *clock, unknown);
  state_.set(S::clock_drift, 0.0, 1e4);
  // After a gap, the position may be wrong by its own standard deviation, which widens the gate.
  const double lost = std::sqrt(state_.P().block<3, 3>(S::position, S::position).trace());
  const double gate = parameters_.code_gate + 4.0 * lost;
  for (Tracked& t : tracked_) {
    if (std::abs(t.code_offset - offset(t) - *clock) > gate) {
      t.code_good = t.phase_good = false;
      solution_.satellites[t.report].refused = PppRefusal::code_far;
    }
  }
}

// Computes the position error due to the ranges' lasting errors alone, by least squares for
// position and clock. An ionosphere without a model lengthens all ranges at once: it moves the
// position along one line.
void PppFilter::weigh_lasting_errors() {
  constexpr double least = 1e-4;  // m^2, a floor for products accurate to millimetres
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d unmodelled = Eigen::Vector4d::Zero();
  int count = 0;
  for (const Tracked& t : tracked_) {
    if (!t.code_good) continue;
    const Eigen::Vector3d u = model_.R_enu_ecef() * t.predicted.to_satellite;
    const Eigen::Vector4d h(-u.x(), -u.y(), -u.z(), 1.0);
    const double weight = 1.0 / std::max(least, lasting_variance(t.predicted));
    normal += weight * h * h.transpose();
    if (t.predicted.ionosphere.value == 0.0)
      unmodelled += weight * t.predicted.ionosphere.sigma * h;
    ++count;
  }
  if (count < 5) return;  // the previous values stay
  const Eigen::Matrix4d covariance = normal.inverse();
  const Eigen::Vector2d variance = covariance.diagonal().head<2>();
  if (!variance.allFinite() || variance.minCoeff() <= 0.0) return;
  const Eigen::Matrix3d R = model_.R_enu_ecef();
  unmodelled_ionosphere_shift_ = R.transpose() * (covariance * unmodelled).head<3>();
  const Eigen::Matrix3d all = R * state_.P().block<3, 3>(S::position, S::position) * R.transpose();
  const bool first = lasting_.isZero();
  lasting_ = variance.cwiseMin(parameters_.map_lasting_share * all.diagonal().head<2>());
  if (first) begin_map_states(state_, lasting_, parameters_);
}

// Applies and reports the rows. A phase that did not fit has slipped: its ambiguity restarts.
void PppFilter::update() {
  for (const Tracked& t : tracked_) {
    const double cn0 = t.measurement.first.cn0;
    if (t.code_good && cn0 > 0.0) unobstructed_cn0_.add(std::sin(t.predicted.elevation), cn0);
  }
  std::vector<Row>& rows =
      rows_.make(tracked_, reference_system_, unobstructed_cn0_, state_, solution_.satellites);
  if (rows.size() < 4) {
    solution_.message = "fewer than four measurements";
    return;
  }
  update_.apply(state_, rows);
  for (const Row& row : rows) {
    const Tracked& t = tracked_[row.tracked];
    SatelliteReport& report = solution_.satellites[t.report];
    switch (row.kind) {
      case RowKind::code:
        report.code_residual = row.residual_after(update_.dx());
        levels_.add(t.measurement.satellite, report.code_residual * report.code_residual /
                                                 (row.sigma * row.sigma) * t.level);
        report.code_used = row.active;
        if (!row.active) report.refused = PppRefusal::code_misfit;
        break;
      case RowKind::phase:
        report.phase_residual = row.residual_after(update_.dx());
        report.phase_used = row.active;
        if (row.active) break;
        report.refused = PppRefusal::phase_misfit;
        if (!row.doubtful) state_.remove_ambiguity(t.measurement.satellite);
        break;
      case RowKind::doppler:
        if (!row.active) report.refused = PppRefusal::doppler_misfit;
        break;
    }
  }
  disagrees_ = disagree(rows);
}

void PppFilter::forget_absent() {
  for (std::size_t i = state_.ambiguities().size(); i-- > 0;) {
    const Satellite satellite = state_.ambiguities()[i];
    if (memory_[satellite.slot()].epochs_away > parameters_.longest_gap) {
      state_.remove_ambiguity(satellite);
    }
  }
}

// Returns whether the codes are far from the position, or more than half their number is left out.
bool PppFilter::disagree(const std::vector<Row>& rows) const {
  int codes = 0, left_out = 0;
  double sum = 0.0;
  for (const Row& row : rows) {
    if (row.kind == RowKind::doppler) continue;
    left_out += !row.active;
    if (row.kind != RowKind::code) continue;
    const double residual = row.residual_after(update_.dx());
    sum += residual * residual / (row.sigma * row.sigma);
    ++codes;
  }
  for (const Tracked& t : tracked_) left_out += !t.code_good;
  constexpr double max_variance = 9.0;  // relative to the expected variance
  return codes >= 4 && (sum > max_variance * codes || 2 * left_out > codes);
}

// Adds the part of the lasting error that the map has revealed. The rows count that error as noise,
// so the covariance without a map already contains its full size.
void PppFilter::add_lasting_error() {
  const Eigen::Matrix3d& R = model_.R_enu_ecef();
  const auto P = state_.P();
  const Eigen::Matrix3d own = R * solution_.covariance * R.transpose();
  const Eigen::Matrix2d lasting = P.block<2, 2>(S::lasting_error, S::lasting_error);
  const Eigen::Matrix<double, 3, 2> crossed = R * P.block<3, 2>(S::position, S::lasting_error);
  Eigen::Matrix3d sum = own;
  sum.leftCols<2>() += crossed;
  sum.topRows<2>() += crossed.transpose();
  sum.topLeftCorner<2, 2>() += lasting;
  // The scale would turn the sum of two uncorrelated covariances back into the first.
  const Eigen::Matrix2d once = own.topLeftCorner<2, 2>(), twice = once + lasting;
  Eigen::Matrix3d shrink = Eigen::Matrix3d::Identity();
  // (23) of METHOD.md
  shrink.topLeftCorner<2, 2>() =
      Eigen::Matrix2d(once.llt().matrixL()) * Eigen::Matrix2d(twice.llt().matrixL()).inverse();
  solution_.position += R.topRows<2>().transpose() * state_.x().segment<2>(S::lasting_error);
  solution_.covariance = R.transpose() * shrink * sum * shrink.transpose() * R;
}

Eigen::Matrix2d PppFilter::level_covariance() const {
  const Eigen::Matrix<double, 2, 3> to_east_north =
      rotation_enu_ecef(geodetic_from_ecef(solution_.position)).topRows<2>();
  return to_east_north * solution_.covariance * to_east_north.transpose();
}

void PppFilter::report() {
  const auto x = state_.x();
  const auto P = state_.P();
  solution_.position = x.segment<3>(S::position);
  solution_.covariance =
      P.block<3, 3>(S::position, S::position) +
      parameters_.model_sigma * parameters_.model_sigma * Eigen::Matrix3d::Identity() +
      unmodelled_ionosphere_shift_ * unmodelled_ionosphere_shift_.transpose();
  if (has_map_) add_lasting_error();
  solution_.velocity = x.segment<3>(S::velocity);
  solution_.velocity_covariance = P.block<3, 3>(S::velocity, S::velocity);
  solution_.clock = x[S::clock];
  solution_.running_for = to_seconds(time_ - started_at_);
  const ZenithDelay& guess = model_.zenith();
  solution_.zenith_delay = guess.hydrostatic + guess.wet + x[S::zenith_wet];
  solution_.zenith_delay_sigma = std::sqrt(P(S::zenith_wet, S::zenith_wet));
  for (const SatelliteReport& s : solution_.satellites) {
    solution_.satellites_used += s.code_used || s.phase_used;
  }
  if (solution_.satellites_used < 4) {
    if (solution_.message.empty()) solution_.message = "fewer than four satellites";
    return;
  }
  constexpr double converged = 0.1;  // m, horizontal
  const Eigen::Matrix3d enu =
      model_.R_enu_ecef() * solution_.covariance * model_.R_enu_ecef().transpose();
  const bool small = std::sqrt(enu(0, 0) + enu(1, 1)) < converged;
  solution_.status = small ? PppStatus::converged : PppStatus::converging;
}

}  // namespace maploop::ppp
