#include "ppp/integers/integer_fix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

// Integers are exact; this keeps the update well conditioned, cycles^2.
constexpr double integer_variance = 1e-4;

// A single ambiguity is an integer if the others determine it to this, cycles.
constexpr double own_sigma = 0.05, own_distance = 0.15;

// Returns the ionosphere-free ambiguity, m.
double value(const FilterState& state, const IntegerCandidate& c) {
  const auto x = state.x();
  return c.weights[0] * x[c.indices[0]] + c.weights[1] * x[c.indices[1]];
}

// Returns the covariance of two ionosphere-free ambiguities, m^2.
double covariance_of(const FilterState& state, const IntegerCandidate& a,
                     const IntegerCandidate& b) {
  const auto P = state.P();
  double sum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      sum += a.weights[i] * b.weights[k] * P(a.indices[i], b.indices[k]);
  }
  return sum;
}

}  // namespace

IntegerFix::IntegerFix(const PppParameters& parameters)
    : parameters_(parameters), known_(satellite_slots), dx_(FilterState::capacity) {
  candidates_.reserve(satellite_slots);
  differenced_.reserve(satellite_slots);
}

void IntegerFix::reset() {
  wide_lanes_.reset();
  known_.assign(satellite_slots, {});
  unchanged_since_.reset();
}

const FilterState* IntegerFix::resolve(const FilterState& state,
                                       const std::vector<Tracked>& tracked,
                                       const std::vector<Row>& rows, GpsTime t,
                                       IntegerReport& report,
                                       std::vector<SatelliteReport>& satellites) {
  take(state, tracked, rows);
  choose_references(state);
  report.candidates = static_cast<int>(differenced_.size());
  if (report.candidates < parameters_.integer_fewest) return nullptr;
  fill_differences(state);
  const int count = search(report);
  if (count == 0) return nullptr;
  condition(state, count);
  find_own_integers();
  if (!confirmed(t)) {
    report.outcome = IntegerOutcome::unconfirmed;
    return nullptr;
  }
  report.outcome = IntegerOutcome::used;
  for (const IntegerCandidate& c : candidates_) {
    satellites[tracked[c.tracked].measurement.report].integer = c.own.has_value();
    report.used += c.own.has_value();
  }
  return &fixed_;
}

// Learns the wide lanes of this epoch, and lists the ambiguities that can be integers.
void IntegerFix::take(const FilterState& state, const std::vector<Tracked>& tracked,
                      const std::vector<Row>& rows) {
  candidates_.clear();
  candidates_.reserve(usual_satellites);
  // Of each satellite, the rows of the range come before those of the ionosphere, and each code
  // before its phase.
  const Row *code = nullptr, *range = nullptr;
  for (const Row& row : rows) {
    const Tracked& t = tracked[row.tracked];
    const Measurement& m = t.measurement;
    if (row.kind == RowKind::code) code = &row;
    if (row.kind != RowKind::phase) continue;
    if (row.new_ambiguity || !row.active) {
      wide_lanes_.restart(m.satellite);
      known_[m.satellite.slot()] = {};
    }
    if (row.combination == Combination::range) {
      range = &row;
      continue;
    }
    if (!m.integer || code == nullptr || range == nullptr || range->tracked != row.tracked)
      continue;
    if (!range->active || range->doubtful) continue;
    if (!row.active || row.doubtful) continue;
    const double size = code->sigma * code->sigma;
    wide_lanes_.add(m, 2.0 * size, code->variance / size);  // of half the difference of two codes
    IntegerCandidate c;
    c.satellite = m.satellite;
    c.tracked = row.tracked;
    c.indices = {state.find(m.satellite, Part::ambiguity),
                 state.find(m.satellite, Part::ionosphere_ambiguity)};
    c.weights = {1.0, m.ionosphere_free_weight()};
    c.length = speed_of_light / (m.first.frequency + m.second.frequency);
    c.wide_factor = m.second.frequency / (m.first.frequency - m.second.frequency);
    if (t.predicted.calibrated && !t.predicted.in_shadow &&
        t.predicted.elevation >= radians(parameters_.integer_elevation))
      candidates_.push_back(c);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const auto& a, const auto& b) { return a.satellite < b.satellite; });
}

// The most precise ambiguity of each system is the one that the others are differenced against.
void IntegerFix::choose_references(const FilterState& state) {
  differenced_.clear();
  differenced_.reserve(usual_satellites);
  for (std::size_t begin = 0, end = 0; begin < candidates_.size(); begin = end) {
    const System system = candidates_[begin].satellite.system;
    while (end < candidates_.size() && candidates_[end].satellite.system == system) ++end;
    const auto own = std::span(candidates_).subspan(begin, end - begin);
    wide_lanes_.resolve(own, parameters_.wide_lane_sigma, parameters_.wide_lane_fraction);
    const auto reference =
        std::min_element(own.begin(), own.end(), [&](const auto& a, const auto& b) {
          return a.resolved != b.resolved ? a.resolved
                                          : covariance_of(state, a, a) < covariance_of(state, b, b);
        });
    const std::size_t at = begin + static_cast<std::size_t>(reference - own.begin());
    for (std::size_t i = begin; i < end; ++i) {
      candidates_[i].reference = at;
      const bool room = differenced_.size() < static_cast<std::size_t>(Lambda::max_size);
      if (candidates_[i].resolved && i != at && room) differenced_.push_back(i);
    }
  }
}

const IntegerCandidate& IntegerFix::reference_of(const IntegerCandidate& c) const {
  return candidates_[c.reference];
}

// Returns how far an ambiguity is beyond its reference, narrow lanes.
double IntegerFix::difference(const FilterState& state, const IntegerCandidate& c) const {
  const IntegerCandidate& r = reference_of(c);
  // (25) of METHOD.md
  return (value(state, c) - value(state, r)) / c.length -
         c.wide_factor * (c.wide_lane - r.wide_lane);
}

// Returns the covariance of two such differences, narrow lanes^2.
double IntegerFix::covariance(const FilterState& state, const IntegerCandidate& a,
                              const IntegerCandidate& b) const {
  const IntegerCandidate &ra = reference_of(a), &rb = reference_of(b);
  return (covariance_of(state, a, b) - covariance_of(state, a, rb) - covariance_of(state, ra, b) +
          covariance_of(state, ra, rb)) /
         (a.length * b.length);
}

void IntegerFix::fill_differences(const FilterState& state) {
  const auto n = static_cast<Eigen::Index>(differenced_.size());
  real_.resize(n);
  covariance_.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const IntegerCandidate& a = candidates_[differenced_[static_cast<std::size_t>(i)]];
    real_[i] = difference(state, a);
    for (Eigen::Index k = 0; k <= i; ++k) {
      const IntegerCandidate& b = candidates_[differenced_[static_cast<std::size_t>(k)]];
      covariance_(i, k) = covariance_(k, i) = covariance(state, a, b);
    }
  }
}

// Returns how many decorrelated ambiguities have certain integers, 0 if too few do.
int IntegerFix::search(IntegerReport& report) {
  report.outcome = IntegerOutcome::uncertain;
  if (!lambda_.decorrelate(real_, parameters_.integer_variance_factor * covariance_)) return 0;
  int count = lambda_.size();
  while (count > 0 && lambda_.success_rate(count) < parameters_.integer_success) --count;
  for (; count >= parameters_.integer_fewest; --count) {
    const auto found = lambda_.search(count);
    if (!found) continue;
    report.success_rate = lambda_.success_rate(count);
    report.ratio = found->next_distance / found->distance;
    report.misfit = found->distance / count;
    report.outcome = report.ratio < parameters_.integer_ratio ? IntegerOutcome::not_distinct
                                                              : IntegerOutcome::misfit;
    if (report.ratio < parameters_.integer_ratio || report.misfit > parameters_.integer_misfit)
      continue;
    integers_ = found->integers;
    return count;
  }
  return 0;
}

// Applies the integers of the last `count` decorrelated ambiguities to a copy of the state.
void IntegerFix::condition(const FilterState& state, int count) {
  fixed_ = state;
  dx_.setZero();
  std::array<int, 4 * Lambda::max_size> indices{};
  std::array<double, 4 * Lambda::max_size> h{};
  for (int j = 0; j < count; ++j) {
    const auto z = lambda_.transformation().col(lambda_.size() - count + j);
    std::size_t used = 0;
    for (std::size_t i = 0; i < differenced_.size(); ++i) {
      const double share = z[static_cast<Eigen::Index>(i)];
      if (share == 0.0) continue;
      const IntegerCandidate& c = candidates_[differenced_[i]];
      for (std::size_t k = 0; k < 2; ++k) {
        indices[used] = c.indices[k];
        h[used++] = c.weights[k] * share / c.length;
        indices[used] = reference_of(c).indices[k];
        h[used++] = -reference_of(c).weights[k] * share / c.length;
      }
    }
    fixed_.update(std::span(indices).first(used), std::span(h).first(used),
                  integers_[j] - z.dot(real_), integer_variance, dx_);
  }
  fixed_.x() += dx_.head(fixed_.size());
}

// Combinations of ambiguities are fixed, which determine most of the single ones.
void IntegerFix::find_own_integers() {
  for (const std::size_t i : differenced_) {
    IntegerCandidate& c = candidates_[i];
    const double real = difference(fixed_, c), nearest = std::round(real);
    if (covariance(fixed_, c, c) > own_sigma * own_sigma || std::abs(real - nearest) > own_distance)
      continue;
    c.own = nearest;
    candidates_[c.reference].own = 0.0;
  }
}

// Integers are used once none of them has changed for a while. A number that a system's satellites
// share may change with the satellite that they are differenced against.
bool IntegerFix::confirmed(GpsTime t) {
  struct Shift {
    bool known = false;
    double narrow = 0.0, wide = 0.0;
  };
  std::array<Shift, system_count> shifts{};
  bool same = true, comparable = false;
  for (const IntegerCandidate& c : candidates_) {
    const Known& before = known_[c.satellite.slot()];
    if (!c.own || !before.known) continue;
    const Shift now{true, before.narrow - *c.own, before.wide - c.wide_lane};
    Shift& shift = shifts[static_cast<std::size_t>(c.satellite.system)];
    same &= !shift.known || (now.narrow == shift.narrow && now.wide == shift.wide);
    comparable |= shift.known;
    shift = now;
  }
  if (!same || !comparable || !unchanged_since_) {
    unchanged_since_ = t;
    for (Known& k : known_) k = {};
    shifts = {};
  }
  for (const IntegerCandidate& c : candidates_) {
    const Shift& shift = shifts[static_cast<std::size_t>(c.satellite.system)];
    if (c.own) known_[c.satellite.slot()] = {true, *c.own + shift.narrow, c.wide_lane + shift.wide};
  }
  return std::chrono::abs(t - *unchanged_since_) >= from_seconds(parameters_.integer_confirmation);
}

}  // namespace maploop::ppp
