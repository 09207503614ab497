#include "ppp/filter/ppp_filter.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::size_t slot(Satellite s) {
  return static_cast<std::size_t>(s.slot());
}

}  // namespace

const char* name(PppStatus status) {
  switch (status) {
    case PppStatus::none:
      return "none";
    case PppStatus::single:
      return "single";
    case PppStatus::converging:
      return "converging";
    case PppStatus::converged:
      return "converged";
  }
  return "none";
}

PppFilter::PppFilter(const PppParameters& parameters, const Surroundings& surroundings, Earth earth)
    : parameters_(parameters),
      model_(surroundings, std::move(earth)),
      memory_(satellite_slots),
      dx_(S::capacity) {}

void PppFilter::reset() {
  state_.clear();
  std::fill(memory_.begin(), memory_.end(), Memory{});
  started_ = false;
  reference_system_ = -1;
  has_offset_.fill(false);
  bad_epochs_ = 0;
}

const PppSolution& PppFilter::process(const Epoch& epoch) {
  const double interval = started_ ? to_seconds(epoch.time - time_) : 0.0;
  solution_ = {};
  solution_.time = epoch.time;
  measure_all(epoch);
  if (!started_ && !start(epoch)) return solution_;
  if (interval > 0.0) predict(interval);
  time_ = epoch.time;
  model_.begin(time_, state_.x().segment<3>(S::position));
  predict_ranges(interval);
  set_clocks();
  make_rows();
  update();
  forget_absent();

  bad_epochs_ = disagrees() ? bad_epochs_ + 1 : 0;
  report();
  constexpr int patience = 5;  // epochs
  if (bad_epochs_ >= patience) {
    reset();
    solution_.status = PppStatus::none;
    solution_.message = "started again: for 5 epochs measurements have disagreed with the position";
  }
  return solution_;
}

// Chooses carriers; reports every satellite that is there.
void PppFilter::measure_all(const Epoch& epoch) {
  measurements_.clear();
  report_of_.clear();
  for (const SatelliteSignals& s : epoch.satellites) {
    if (parameters_.systems.find(letter(s.satellite.system)) == std::string::npos) continue;
    SatelliteReport report;
    report.satellite = s.satellite;
    const auto m =
        measure(s.satellite, epoch.of(s), model_.surroundings().glonass_channels,
                model_.ephemeris(), epoch.time, model_.surroundings().klobuchar != nullptr);
    if (!m) {
      report.refused = "no code and phase on the carriers used";
    } else if (m->first.cn0 > 0.0 && m->first.cn0 < parameters_.cn0_mask) {
      report.cn0 = m->first.cn0;
      report.refused = "signal too weak";
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
  const SinglePoint point =
      solve_single_point(measurements_, epoch.time, near, radians(parameters_.elevation_mask),
                         std::max(1.0, parameters_.code_sigma), model_);
  if (!point.solved) {
    solution_.message = "no first position: " + point.why_not;
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
  started_ = true;
  return true;
}

void PppFilter::predict(double interval) {
  auto P = state_.P();
  if (parameters_.motion == Motion::kinematic) {
    // Constant velocity under white acceleration.
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
  const double error_walk = std::hypot(parameters_.ambiguity_walk, model_.ephemeris().error_walk());
  for (int i = S::fixed; i < state_.size(); ++i) walk(i, error_walk);
}

// Ranges, masks and slips.
void PppFilter::predict_ranges(double interval) {
  tracked_.clear();
  for (Memory& memory : memory_) ++memory.epochs_away;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    const Measurement& m = measurements_[i];
    SatelliteReport& report = solution_.satellites[report_of_[i]];
    Memory& memory = memory_[slot(m.satellite)];
    const auto predicted = model_.predict(m, memory.wind_up);
    if (!predicted) {
      report.refused = "no orbit or clock, or unhealthy";
      continue;
    }
    report.azimuth = predicted->azimuth;
    report.elevation = predicted->elevation;
    if (predicted->elevation < radians(parameters_.elevation_mask)) {
      report.refused = "below the elevation mask";
      continue;
    }
    Tracked tracked{m, *predicted, report_of_[i],
                    m.code() - predicted->range - predicted->ionosphere};
    tracked.phase_good = m.phase() != 0.0;
    if (tracked.phase_good) {
      const bool away = memory.epochs_away > 1;
      const double since = interval * std::max(1, memory.epochs_away);
      if (memory.epochs_away > parameters_.longest_gap) memory.slips.reset();
      if (const auto slip = memory.slips.next(m, since, predicted->elevation)) {
        report.slip = *slip;
        state_.remove_ambiguity(m.satellite);
      } else if (away && memory.epochs_away > parameters_.longest_gap) {
        state_.remove_ambiguity(m.satellite);
      }
      memory.epochs_away = 0;
    } else {
      report.refused = "no phase";
    }
    tracked_.push_back(tracked);
  }
}

// The receiver's clock, and new systems' offsets from it, from the codes' medians; codes far from
// them are refused.
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
  for (Tracked& t : tracked_) {
    if (std::abs(t.code_offset - offset(t) - *clock) > parameters_.code_gate) {
      t.code_good = t.phase_good = false;
      solution_.satellites[t.report].refused = "code far from the others";
    }
  }
}

void PppFilter::make_rows() {
  rows_.clear();
  double doppler_sum = 0.0;
  const Eigen::Vector3d velocity = state_.x().segment<3>(S::velocity);
  sorted_.clear();
  const auto drift_of = [&](const Tracked& t) {
    const auto& c = t.measurement.first;
    const auto& p = t.predicted;
    const Eigen::Vector3d& s = p.satellite.position;
    const Eigen::Vector3d r = state_.x().segment<3>(S::position);
    const double sagnac = earth_rotation_rate / speed_of_light *
                          (p.satellite.velocity.y() * r.x() + s.y() * velocity.x() -
                           p.satellite.velocity.x() * r.y() - s.x() * velocity.y());
    const double rate = p.to_satellite.dot(p.satellite.velocity - velocity) - sagnac -
                        speed_of_light * p.satellite.clock_drift;
    return -c.doppler * c.wavelength - rate;
  };
  const bool use_doppler = parameters_.motion == Motion::kinematic;
  if (use_doppler) {
    for (const Tracked& t : tracked_) {
      if (t.measurement.first.doppler != 0.0 && t.code_good) sorted_.push_back(drift_of(t));
    }
    if (!sorted_.empty()) doppler_sum = median(sorted_);
    state_.set(S::clock_drift, doppler_sum, 100.0);
  }
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    Tracked& t = tracked_[i];
    if (!t.code_good) continue;
    const Measurement& m = t.measurement;
    const int system = static_cast<int>(m.satellite.system);
    const double sine = std::sin(t.predicted.elevation);
    double weak = 1.0;
    if (parameters_.full_cn0 > 0.0 && m.first.cn0 > 0.0) {
      weak = std::pow(10.0, std::max(0.0, parameters_.full_cn0 - m.first.cn0) / 10.0);
    }
    Row code;
    code.kind = Kind::code;
    code.tracked = i;
    for (int k = 0; k < 3; ++k) code.add(S::position + k, -t.predicted.to_satellite[k]);
    code.add(S::clock, 1.0);
    if (system != reference_system_) code.add(S::system_offset + system, 1.0);
    code.add(S::zenith_wet, t.predicted.wet_mapping);
    if (parameters_.gradients) {
      const double slope = t.predicted.wet_mapping * std::cos(t.predicted.elevation) / sine;
      code.add(S::gradient_north, slope * std::cos(t.predicted.azimuth));
      code.add(S::gradient_east, slope * std::sin(t.predicted.azimuth));
    }
    // What the state predicts besides range: about the x before the update.
    double predicted = 0.0;
    for (int k = 3; k < code.count; ++k) {
      predicted += code.h[static_cast<std::size_t>(k)] *
                   state_.x()[code.indices[static_cast<std::size_t>(k)]];
    }
    const double glonass =
        m.satellite.system == System::glonass ? parameters_.glonass_code_factor : 1;
    const double code_sigma = parameters_.code_sigma * m.noise_factor() * glonass / sine;
    const double lasting = t.predicted.satellite.sigma;
    const double iono = 0.5 * t.predicted.ionosphere;
    code.y = t.code_offset - predicted;
    code.variance = code_sigma * code_sigma * weak + lasting * lasting + iono * iono;
    rows_.push_back(code);
    if (t.phase_good) add_phase_row(i, code);
    if (use_doppler && m.first.doppler != 0.0) {
      Row doppler;
      doppler.kind = Kind::doppler;
      doppler.tracked = i;
      doppler.y = drift_of(t) - doppler_sum;
      for (int k = 0; k < 3; ++k) doppler.add(S::velocity + k, -t.predicted.to_satellite[k]);
      doppler.add(S::clock_drift, 1.0);
      const double sigma = parameters_.doppler_sigma / sine;
      doppler.variance = sigma * sigma * weak;
      rows_.push_back(doppler);
    }
  }
}

// Phase, or with one frequency GRAPHIC: half the sum of code and phase has no ionosphere, and half
// the ambiguity (here one of its own, in metres).
void PppFilter::add_phase_row(std::size_t i, const Row& code) {
  const Tracked& t = tracked_[i];
  const Measurement& m = t.measurement;
  const double sine = std::sin(t.predicted.elevation);
  const bool graphic = !m.dual() && parameters_.graphic;
  const double phase = m.phase() - t.predicted.phase_extra - t.predicted.range;
  const double y =
      graphic ? 0.5 * (phase + m.code() - t.predicted.range) : phase + t.predicted.ionosphere;
  const double predicted = t.code_offset - code.y;  // clocks, wet delay, gradients
  int index = state_.ambiguity(m.satellite);
  if (index < 0) {
    index = state_.add_ambiguity(m.satellite, y - predicted, parameters_.ambiguity_sigma);
    if (index < 0) {
      solution_.satellites[t.report].refused = "no room for its ambiguity";
      return;
    }
  }
  Row row = code;
  row.kind = Kind::phase;
  row.add(index, 1.0);
  row.y = y - predicted - state_.x()[index];
  const double sigma = parameters_.phase_sigma * m.noise_factor() / sine;
  row.variance = sigma * sigma * (t.predicted.in_shadow ? 16.0 : 1.0);
  if (graphic) row.variance += 0.25 * code.variance;
  rows_.push_back(row);
}

int PppFilter::worst_row(const Eigen::VectorXd& dx) const {
  int worst = -1;
  double largest = parameters_.outlier_sigmas;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const Row& row = rows_[r];
    if (!row.active) continue;
    double left = row.y;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      left -= row.h[k] * dx[row.indices[k]];
    }
    const double normalized = std::abs(left) / std::sqrt(row.variance);
    if (normalized > largest) {
      largest = normalized;
      worst = static_cast<int>(r);
    }
  }
  return worst;
}

// Row by row; then the row that fits worst is left out and all is done again, up to 8 times.
void PppFilter::update() {
  constexpr int most_rejections = 8;
  if (rows_.size() < 4) {
    solution_.message = "fewer than four measurements";
    return;
  }
  before_ = state_;
  for (int pass = 0;; ++pass) {
    dx_.setZero();
    for (const Row& row : rows_) {
      if (!row.active) continue;
      const auto n = static_cast<std::size_t>(row.count);
      state_.update(std::span(row.indices).first(n), std::span(row.h).first(n), row.y, row.variance,
                    dx_);
    }
    const int worst = worst_row(dx_);
    if (worst < 0 || pass == most_rejections) break;
    Row& row = rows_[static_cast<std::size_t>(worst)];
    row.active = false;
    solution_.satellites[tracked_[row.tracked].report].refused =
        row.kind == Kind::phase  ? "phase does not fit"
        : row.kind == Kind::code ? "code does not fit"
                                 : "Doppler does not fit";
    state_ = before_;
  }
  state_.x() += dx_.head(state_.size());
  for (const Row& row : rows_) {
    SatelliteReport& report = solution_.satellites[tracked_[row.tracked].report];
    double left = row.y;
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
      left -= row.h[k] * dx_[row.indices[k]];
    }
    if (row.kind == Kind::code) {
      report.code_residual = left;
      report.code_used = row.active;
    } else if (row.kind == Kind::phase) {
      report.phase_residual = left;
      report.phase_used = row.active;
    }
  }
  // A phase that did not fit has slipped: its ambiguity begins anew.
  for (const Row& row : rows_) {
    if (row.kind == Kind::phase && !row.active) {
      state_.remove_ambiguity(tracked_[row.tracked].measurement.satellite);
    }
  }
}

void PppFilter::forget_absent() {
  for (std::size_t i = state_.ambiguities().size(); i-- > 0;) {
    const Satellite satellite = state_.ambiguities()[i];
    if (memory_[slot(satellite)].epochs_away > parameters_.longest_gap) {
      state_.remove_ambiguity(satellite);
    }
  }
}

// Whether codes are far from the position, or most measurements were left out.
bool PppFilter::disagrees() const {
  int codes = 0, left_out = 0;
  double sum = 0.0;
  for (const Row& row : rows_) {
    if (row.kind == Kind::doppler) continue;
    left_out += !row.active;
    if (row.kind != Kind::code) continue;
    const double residual = solution_.satellites[tracked_[row.tracked].report].code_residual;
    sum += residual * residual / row.variance;
    ++codes;
  }
  for (const Tracked& t : tracked_) left_out += !t.code_good;
  constexpr double most_variance = 9.0;  // against what is expected
  return codes >= 4 && (sum > most_variance * codes || 2 * left_out > codes);
}

void PppFilter::report() {
  const auto x = state_.x();
  const auto P = state_.P();
  solution_.position = x.segment<3>(S::position);
  solution_.covariance = P.block<3, 3>(S::position, S::position);
  solution_.velocity = x.segment<3>(S::velocity);
  solution_.velocity_covariance = P.block<3, 3>(S::velocity, S::velocity);
  solution_.clock = x[S::clock];
  solution_.zenith_delay = saastamoinen(geodetic_from_ecef(solution_.position)).hydrostatic +
                           model_.wet_guess() + x[S::zenith_wet];
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
