#include "ppp/integers/ambiguity_differences.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "ppp/filter/row_update.h"

namespace maploop::ppp {
namespace {

// Adds one of a satellite's two ambiguities, in cycles, to a difference.
void add_ambiguity(LinearRow& difference, const IntegerCandidate& c, std::size_t which,
                   double sign) {
  for (std::size_t k = 0; k < c.indices.size(); ++k)
    difference.add(c.indices[k], sign * c.cycles[k][which]);
}

// Returns whether the difference of two satellites of a system consists of integers.
bool difference_is_integer(const IntegerCandidate& a, const IntegerCandidate& b,
                           const DifferenceValues& given) {
  for (Eigen::Index which = 0; which < static_cast<Eigen::Index>(ambiguities_of_one); ++which) {
    const Eigen::Index i = a.difference + which, k = b.difference + which;
    double value = 0.0, variance = 0.0;
    if (a.differenced()) {
      value += given.values[i];
      variance += given.covariance(i, i);
    }
    if (b.differenced()) {
      value -= given.values[k];
      variance += given.covariance(k, k);
    }
    if (a.differenced() && b.differenced()) variance -= 2.0 * given.covariance(i, k);
    if (variance > integer_sigma * integer_sigma ||
        std::abs(value - std::round(value)) > integer_distance)
      return false;
  }
  return true;
}

}  // namespace

AmbiguityDifferences::AmbiguityDifferences() {
  candidates_.reserve(most_candidates);
  differenced_.reserve(most_candidates);
  rows_.reserve(Lambda::max_size);
}

void AmbiguityDifferences::clear() {
  candidates_.clear();
  differenced_.clear();
  rows_.clear();
}

void AmbiguityDifferences::add(const IntegerCandidate& candidate) {
  if (candidates_.size() < most_candidates) candidates_.push_back(candidate);
}

void AmbiguityDifferences::choose_references(const FilterState& state) {
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
      candidates_[i].difference =
          static_cast<Eigen::Index>(ambiguities_of_one * differenced_.size());
      differenced_.push_back(i);
    }
  }
}

void AmbiguityDifferences::make(const FilterState& state) {
  std::sort(candidates_.begin(), candidates_.end(),
            [](const auto& a, const auto& b) { return a.satellite < b.satellite; });
  choose_references(state);
  for (const std::size_t i : differenced_) {
    for (std::size_t which = 0; which < ambiguities_of_one; ++which) {
      LinearRow& difference = rows_.emplace_back();
      add_ambiguity(difference, candidates_[i], which, 1.0);
      add_ambiguity(difference, candidates_[candidates_[i].reference], which, -1.0);
    }
  }
}

void AmbiguityDifferences::evaluate(const FilterState& state, DifferenceValues& result) const {
  const auto n = static_cast<Eigen::Index>(rows_.size());
  result.values.resize(n);
  result.covariance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const LinearRow& a = rows_[static_cast<std::size_t>(i)];
    result.values[i] = value_of(state, a);
    for (Eigen::Index k = 0; k <= i; ++k) {
      const LinearRow& b = rows_[static_cast<std::size_t>(k)];
      result.covariance(i, k) = result.covariance(k, i) = predicted_covariance(state, a, b);
    }
  }
}

void AmbiguityDifferences::mark_integers(const DifferenceValues& given) {
  for (const IntegerCandidate& reference : candidates_) {
    const auto of_system = [&](const auto& c) { return c.reference == reference.reference; };
    const auto known = [&](const auto& c) {
      return of_system(c) && difference_is_integer(c, reference, given);
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

}  // namespace maploop::ppp
