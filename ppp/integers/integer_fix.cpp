#include "ppp/integers/integer_fix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "msgs/frames.h"

namespace maploop::ppp {
namespace {

// Integers are exact; this keeps the update well conditioned, cycles^2.
constexpr double integer_variance = 1e-4;

}  // namespace

IntegerFix::IntegerFix(const PppParameters& parameters)
    : parameters_(parameters), dx_(FilterState::capacity) {}

void IntegerFix::reset() {
  wide_lanes_.reset();
  last_.clear();
  unchanged_since_.reset();
}

const FilterState* IntegerFix::resolve(const FilterState& state,
                                       const std::vector<Tracked>& tracked,
                                       const std::vector<Row>& rows, GpsTime t,
                                       IntegerReport& report,
                                       std::vector<SatelliteReport>& satellites) {
  take(state, tracked, rows);
  differences_.make(state);
  report.candidates = static_cast<int>(differences_.differenced().size());
  if (report.candidates < parameters_.integer_fewest) return nullptr;
  differences_.evaluate(state, real_);
  use_wide_lanes();
  if (!search(report)) return nullptr;
  condition(state);
  differences_.evaluate(fixed_, given_);
  differences_.mark_integers(given_);
  const bool agrees = last_.same(differences_, given_) >= parameters_.integer_fewest;
  if (!unchanged_since_ || !agrees) unchanged_since_ = t;
  last_.remember(differences_, lambda_, integers_);
  if (std::chrono::abs(t - *unchanged_since_) < from_seconds(parameters_.integer_confirmation)) {
    report.outcome = IntegerOutcome::unconfirmed;
    return nullptr;
  }
  report.outcome = IntegerOutcome::used;
  for (const IntegerCandidate& c : differences_.candidates()) {
    satellites[tracked[c.tracked].measurement.report].integer = c.own;
    report.used += c.own;
  }
  return &fixed_;
}

// Lists the satellites whose ambiguities can be integers.
void IntegerFix::take(const FilterState& state, const std::vector<Tracked>& tracked,
                      const std::vector<Row>& rows) {
  differences_.clear();
  // The rows of a satellite's range come before those of its ionosphere, and each code comes before
  // its phase.
  const Row *code = nullptr, *range = nullptr;
  for (const Row& row : rows) {
    const Tracked& t = tracked[row.tracked];
    const Measurement& m = t.measurement;
    if (row.kind == RowKind::code) code = &row;
    if (row.kind != RowKind::phase) continue;
    if (row.new_ambiguity || !row.active) {
      wide_lanes_.restart(m.satellite);
      last_.forget(m.satellite);
    }
    if (row.combination == Combination::range) {
      range = &row;
      continue;
    }
    const auto usable = [](const Row& r) { return r.active && !r.doubtful; };
    if (!m.integer || code == nullptr || range == nullptr || range->tracked != row.tracked)
      continue;
    if (!usable(*range) || !usable(row)) continue;
    const double size = code->sigma * code->sigma;
    wide_lanes_.add(m, 2.0 * size, code->variance / size);  // of half the difference of two codes
    if (!t.predicted.calibrated || t.predicted.in_shadow ||
        t.predicted.elevation < radians(parameters_.integer_elevation))
      continue;
    IntegerCandidate c;
    c.satellite = m.satellite;
    c.tracked = row.tracked;
    c.indices = {state.find(m.satellite, Part::ambiguity),
                 state.find(m.satellite, Part::ionosphere_ambiguity)};
    const double first = 1.0 / m.first.wavelength, second = 1.0 / m.second.wavelength;
    c.cycles = {Integers{first, first - second},
                Integers{-first, -first - second}};  // (25) of METHOD.md
    differences_.add(c);
  }
}

// Corrects the differences by the measured wide lanes. Each has the noise of the satellite's and
// that of its reference's, which it shares with others.
void IntegerFix::use_wide_lanes() {
  const std::vector<IntegerCandidate>& candidates = differences_.candidates();
  const std::vector<std::size_t>& differenced = differences_.differenced();
  const auto n = static_cast<Eigen::Index>(differenced.size());
  const auto mean = [&](std::size_t i) { return wide_lanes_.of(candidates[i].satellite); };
  const auto variance = [&](std::size_t i) {
    return mean(i).variance() + parameters_.wide_lane_sigma * parameters_.wide_lane_sigma;
  };
  Lambda::Vector off(n);
  Lambda::Matrix sum(n, n), with_all(real_.values.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t at = differenced[static_cast<std::size_t>(i)];
    const std::size_t reference = candidates[at].reference;
    const Eigen::Index wide = candidates[at].difference + 1;
    off[i] = mean(at).cycles - mean(reference).cycles - real_.values[wide];
    with_all.col(i) = real_.covariance.col(wide);
    for (Eigen::Index k = 0; k < n; ++k) {
      const IntegerCandidate& other = candidates[differenced[static_cast<std::size_t>(k)]];
      sum(i, k) = real_.covariance(wide, other.difference + 1);
      if (other.reference == reference) sum(i, k) += variance(reference);
    }
    sum(i, i) += variance(at);
  }
  const Lambda::Matrix gain = sum.ldlt().solve(with_all.transpose()).transpose();
  measured_.values = real_.values + gain * off;
  measured_.covariance = real_.covariance - gain * with_all.transpose();
}

// Finds the integers of as many decorrelated ambiguities as are certain. Returns false if too few
// are.
bool IntegerFix::search(IntegerReport& report) {
  report.outcome = IntegerOutcome::uncertain;
  if (!lambda_.decorrelate(measured_.values, measured_.covariance)) return false;
  int count = lambda_.size();
  while (count > 0 && lambda_.success_rate(count) < parameters_.integer_success) --count;
  for (; count >= parameters_.integer_fewest; --count) {
    const auto found = lambda_.search(count);
    if (!found) continue;
    report.success_rate = lambda_.success_rate(count);
    report.ratio = found->next_distance / found->distance;
    report.misfit = found->distance / count;
    report.margin = (found->next_distance - found->distance) / std::max(1.0, report.misfit);
    const bool distinct = report.margin >= parameters_.integer_margin;
    report.outcome = distinct ? IntegerOutcome::misfit : IntegerOutcome::not_distinct;
    if (!distinct || report.misfit > parameters_.integer_misfit) continue;
    integers_ = found->integers;
    return true;
  }
  return false;
}

// Applies the integers of the last decorrelated ambiguities to a copy of the state.
void IntegerFix::condition(const FilterState& state) {
  fixed_ = state;
  dx_.setZero();
  std::array<int, 4 * Lambda::max_size> indices{};
  std::array<double, 4 * Lambda::max_size> h{};
  for (Eigen::Index j = 0; j < integers_.size(); ++j) {
    const auto z = lambda_.transformation().col(lambda_.size() - integers_.size() + j);
    std::size_t used = 0;
    for (std::size_t i = 0; i < differences_.rows().size(); ++i) {
      const double share = z[static_cast<Eigen::Index>(i)];
      if (share == 0.0) continue;
      const LinearRow& difference = differences_.rows()[i];
      for (std::size_t k = 0; k < static_cast<std::size_t>(difference.count); ++k) {
        indices[used] = difference.indices[k];
        h[used++] = share * difference.h[k];
      }
    }
    fixed_.update(std::span(indices).first(used), std::span(h).first(used),
                  integers_[j] - z.dot(real_.values), integer_variance, dx_);
  }
  fixed_.x() += dx_.head(fixed_.size());
}

}  // namespace maploop::ppp
