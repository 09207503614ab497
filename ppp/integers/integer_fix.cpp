#include "ppp/integers/integer_fix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "msgs/frames.h"
#include "ppp/filter/row_update.h"

namespace maploop::ppp {
namespace {

// Integers are exact; this keeps the update well conditioned, cycles^2.
constexpr double integer_variance = 1e-4;

// A single ambiguity is an integer if the others determine it to this, cycles.
constexpr double own_sigma = 0.05, own_distance = 0.15;

constexpr std::size_t of_one = std::tuple_size_v<Integers>;  // ambiguities of one satellite
constexpr std::size_t most_candidates = Lambda::max_size / of_one;

double value(const FilterState& state, const LinearRow& row) {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(row.count); ++i)
    sum += row.h[i] * state.x()[row.indices[i]];
  return sum;
}

double covariance_of(const FilterState& state, const LinearRow& a, const LinearRow& b) {
  const auto P = state.P();
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(b.count); ++k)
      sum += a.h[i] * b.h[k] * P(a.indices[i], b.indices[k]);
  }
  return sum;
}

// Adds one of a satellite's two ambiguities, in cycles, to a difference.
void add(LinearRow& difference, const IntegerCandidate& c, std::size_t which, double sign) {
  for (std::size_t k = 0; k < c.indices.size(); ++k)
    difference.add(c.indices[k], sign * c.cycles[k][which]);
}

}  // namespace

IntegerFix::IntegerFix(const PppParameters& parameters)
    : parameters_(parameters), dx_(FilterState::capacity) {
  candidates_.reserve(most_candidates);
  differenced_.reserve(most_candidates);
  differences_.reserve(Lambda::max_size);
  last_.satellites.reserve(most_candidates);
  last_.shares.reserve(Lambda::max_size * Lambda::max_size);
  last_.integers.reserve(Lambda::max_size);
}

void IntegerFix::reset() {
  wide_lanes_.reset();
  last_.satellites.clear();
  last_.shares.clear();
  last_.integers.clear();
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
  make_differences();
  evaluate(state, real_);
  use_wide_lanes();
  const int count = search(report);
  if (count == 0) return nullptr;
  condition(state, count);
  evaluate(fixed_, given_);
  find_own_integers();
  if (!unchanged_since_ || !agrees_with_last()) unchanged_since_ = t;
  remember(count);
  if (std::chrono::abs(t - *unchanged_since_) < from_seconds(parameters_.integer_confirmation)) {
    report.outcome = IntegerOutcome::unconfirmed;
    return nullptr;
  }
  report.outcome = IntegerOutcome::used;
  for (const IntegerCandidate& c : candidates_) {
    satellites[tracked[c.tracked].measurement.report].integer = c.own;
    report.used += c.own;
  }
  return &fixed_;
}

// Lists the satellites whose ambiguities can be integers.
void IntegerFix::take(const FilterState& state, const std::vector<Tracked>& tracked,
                      const std::vector<Row>& rows) {
  candidates_.clear();
  // Of each satellite, the rows of the range come before those of the ionosphere, and each code
  // before its phase.
  const Row *code = nullptr, *range = nullptr;
  for (const Row& row : rows) {
    const Tracked& t = tracked[row.tracked];
    const Measurement& m = t.measurement;
    if (row.kind == RowKind::code) code = &row;
    if (row.kind != RowKind::phase) continue;
    if (row.new_ambiguity || !row.active) restart(m.satellite);
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
        t.predicted.elevation < radians(parameters_.integer_elevation) ||
        candidates_.size() == most_candidates)
      continue;
    IntegerCandidate c;
    c.satellite = m.satellite;
    c.tracked = row.tracked;
    c.indices = {state.find(m.satellite, Part::ambiguity),
                 state.find(m.satellite, Part::ionosphere_ambiguity)};
    const double first = 1.0 / m.first.wavelength, second = 1.0 / m.second.wavelength;
    c.cycles = {Integers{first, first - second},
                Integers{-first, -first - second}};  // (25) of METHOD.md
    candidates_.push_back(c);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const auto& a, const auto& b) { return a.satellite < b.satellite; });
}

// The most precise ambiguity of each system is the one that the others are differenced against.
void IntegerFix::choose_references(const FilterState& state) {
  differenced_.clear();
  const auto variance = [P = state.P()](const IntegerCandidate& c) {
    return P(c.indices[0], c.indices[0]);
  };
  for (std::size_t begin = 0, end = 0; begin < candidates_.size(); begin = end) {
    const System system = candidates_[begin].satellite.system;
    while (end < candidates_.size() && candidates_[end].satellite.system == system) ++end;
    const auto own = std::span(candidates_).subspan(begin, end - begin);
    const auto reference =
        std::min_element(own.begin(), own.end(),
                         [&](const auto& a, const auto& b) { return variance(a) < variance(b); });
    const std::size_t at = begin + static_cast<std::size_t>(reference - own.begin());
    for (std::size_t i = begin; i < end; ++i) {
      candidates_[i].reference = at;
      if (i == at) continue;
      candidates_[i].difference = static_cast<Eigen::Index>(of_one * differenced_.size());
      differenced_.push_back(i);
    }
  }
}

void IntegerFix::make_differences() {
  differences_.clear();
  for (const std::size_t i : differenced_) {
    for (std::size_t which = 0; which < of_one; ++which) {
      LinearRow& difference = differences_.emplace_back();
      add(difference, candidates_[i], which, 1.0);
      add(difference, candidates_[candidates_[i].reference], which, -1.0);
    }
  }
}

void IntegerFix::evaluate(const FilterState& state, Differences& result) const {
  const auto n = static_cast<Eigen::Index>(differences_.size());
  result.values.resize(n);
  result.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const LinearRow& a = differences_[static_cast<std::size_t>(i)];
    result.values[i] = value(state, a);
    for (Eigen::Index k = 0; k <= i; ++k) {
      const LinearRow& b = differences_[static_cast<std::size_t>(k)];
      result.covariance(i, k) = result.covariance(k, i) = covariance_of(state, a, b);
    }
  }
}

// Corrects the differences by the measured wide lanes. Each has the noise of the satellite's and
// that of its reference's, which it shares with others.
void IntegerFix::use_wide_lanes() {
  const auto n = static_cast<Eigen::Index>(differenced_.size());
  const auto mean = [this](std::size_t i) { return wide_lanes_.of(candidates_[i].satellite); };
  const auto variance = [&](std::size_t i) {
    return mean(i).variance() + parameters_.wide_lane_sigma * parameters_.wide_lane_sigma;
  };
  Lambda::Vector off(n);
  Lambda::Matrix sum(n, n), with_all(real_.values.size(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t at = differenced_[static_cast<std::size_t>(i)];
    const std::size_t reference = candidates_[at].reference;
    const Eigen::Index wide = candidates_[at].difference + 1;
    off[i] = mean(at).cycles - mean(reference).cycles - real_.values[wide];
    with_all.col(i) = real_.covariance.col(wide);
    for (Eigen::Index k = 0; k < n; ++k) {
      const IntegerCandidate& other = candidates_[differenced_[static_cast<std::size_t>(k)]];
      sum(i, k) = real_.covariance(wide, other.difference + 1);
      if (other.reference == reference) sum(i, k) += variance(reference);
    }
    sum(i, i) += variance(at);
  }
  const Lambda::Matrix gain = sum.ldlt().solve(with_all.transpose()).transpose();
  measured_.values = real_.values + gain * off;
  measured_.covariance = real_.covariance - gain * with_all.transpose();
}

// Returns how many decorrelated ambiguities have certain integers, 0 if too few do.
int IntegerFix::search(IntegerReport& report) {
  report.outcome = IntegerOutcome::uncertain;
  if (!lambda_.decorrelate(measured_.values, measured_.covariance)) return 0;
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
    for (std::size_t i = 0; i < differences_.size(); ++i) {
      const double share = z[static_cast<Eigen::Index>(i)];
      if (share == 0.0) continue;
      const LinearRow& difference = differences_[i];
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

// Combinations of ambiguities are fixed. Those of single satellites are known in the largest group
// of a system in which they determine all differences from one of them.
void IntegerFix::find_own_integers() {
  for (const IntegerCandidate& reference : candidates_) {
    const auto of_system = [&](const auto& c) { return c.reference == reference.reference; };
    const auto known = [&](const auto& c) {
      return of_system(c) && difference_is_integer(c, reference);
    };
    const auto owned = [&](const auto& c) { return of_system(c) && c.own; };
    const auto count = std::count_if(candidates_.begin(), candidates_.end(), known);
    const auto before = std::count_if(candidates_.begin(), candidates_.end(), owned);
    if (count < 2 || count <= before) continue;
    for (IntegerCandidate& c : candidates_) {
      if (of_system(c)) c.own = known(c);
    }
  }
}

bool IntegerFix::difference_is_integer(const IntegerCandidate& a, const IntegerCandidate& b) const {
  for (Eigen::Index which = 0; which < static_cast<Eigen::Index>(of_one); ++which) {
    const Eigen::Index i = a.difference + which, k = b.difference + which;
    double value = 0.0, variance = 0.0;
    if (a.differenced()) {
      value += given_.values[i];
      variance += given_.covariance(i, i);
    }
    if (b.differenced()) {
      value -= given_.values[k];
      variance += given_.covariance(k, k);
    }
    if (a.differenced() && b.differenced()) variance -= 2.0 * given_.covariance(i, k);
    if (variance > own_sigma * own_sigma || std::abs(value - std::round(value)) > own_distance)
      return false;
  }
  return true;
}

// Returns whether the state given the integers has those of the last epoch, as far as it determines
// them.
bool IntegerFix::agrees_with_last() const {
  const std::size_t width = of_one * last_.satellites.size();
  int same = 0;
  for (std::size_t j = 0; j < last_.integers.size(); ++j) {
    const std::span<const double> shares = std::span(last_.shares).subspan(j * width, width);
    Lambda::Vector z = Lambda::Vector::Zero(given_.values.size());
    bool comparable = true;
    for (std::size_t s = 0; s < last_.satellites.size(); ++s) {
      const auto own = shares.subspan(of_one * s, of_one);
      if (std::all_of(own.begin(), own.end(), [](double share) { return share == 0.0; })) continue;
      const auto of_this = [&](const IntegerCandidate& c) {
        return c.satellite == last_.satellites[s];
      };
      const auto found = std::find_if(candidates_.begin(), candidates_.end(), of_this);
      comparable = found != candidates_.end();
      if (!comparable) break;
      for (std::size_t i = 0; i < differenced_.size(); ++i) {
        if (&candidates_[differenced_[i]] != &*found) continue;
        for (std::size_t which = 0; which < of_one; ++which)
          z[static_cast<Eigen::Index>(of_one * i + which)] = own[which];
      }
    }
    if (!comparable || z.dot(given_.covariance * z) > own_sigma * own_sigma) continue;
    if (std::abs(z.dot(given_.values) - last_.integers[j]) > own_distance) return false;
    ++same;
  }
  return same >= parameters_.integer_fewest;
}

void IntegerFix::remember(int count) {
  last_.satellites.clear();
  last_.shares.clear();
  last_.integers.assign(integers_.data(), integers_.data() + count);
  for (const IntegerCandidate& c : candidates_) last_.satellites.push_back(c.satellite);
  const std::size_t width = of_one * candidates_.size();
  for (int j = 0; j < count; ++j) {
    const auto z = lambda_.transformation().col(lambda_.size() - count + j);
    last_.shares.resize(last_.shares.size() + width);
    const std::span<double> shares = std::span(last_.shares).last(width);
    for (std::size_t i = 0; i < differenced_.size(); ++i) {
      const std::size_t at = differenced_[i], reference = candidates_[at].reference;
      for (std::size_t which = 0; which < of_one; ++which) {
        const double share = z[static_cast<Eigen::Index>(of_one * i + which)];
        shares[of_one * at + which] += share;
        shares[of_one * reference + which] -= share;
      }
    }
  }
}

// Forgets what earlier epochs say of a satellite whose ambiguity has begun anew.
void IntegerFix::restart(Satellite satellite) {
  wide_lanes_.restart(satellite);
  for (Satellite& s : last_.satellites) {
    if (s == satellite) s = {};
  }
}

}  // namespace maploop::ppp
