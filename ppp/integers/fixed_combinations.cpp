#include "ppp/integers/fixed_combinations.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace maploop::ppp {

FixedCombinations::FixedCombinations() {
  satellites_.reserve(AmbiguityDifferences::most_candidates);
  shares_.reserve(Lambda::max_size * Lambda::max_size);
  integers_.reserve(Lambda::max_size);
}

void FixedCombinations::clear() {
  satellites_.clear();
  shares_.clear();
  integers_.clear();
}

void FixedCombinations::remember(const AmbiguityDifferences& differences, const Lambda& lambda,
                                 const Lambda::Vector& integers) {
  clear();
  integers_.assign(integers.begin(), integers.end());
  const std::vector<IntegerCandidate>& candidates = differences.candidates();
  for (const IntegerCandidate& c : candidates) satellites_.push_back(c.satellite);
  const std::size_t width = ambiguities_of_one * candidates.size();
  for (Eigen::Index j = lambda.size() - integers.size(); j < lambda.size(); ++j) {
    shares_.resize(shares_.size() + width);
    const std::span<double> shares = std::span(shares_).last(width);
    for (const std::size_t i : differences.differenced()) {
      for (std::size_t which = 0; which < ambiguities_of_one; ++which) {
        const Eigen::Index row = candidates[i].difference + static_cast<Eigen::Index>(which);
        const double share = lambda.transformation()(row, j);
        shares[ambiguities_of_one * i + which] += share;
        shares[ambiguities_of_one * candidates[i].reference + which] -= share;
      }
    }
  }
}

int FixedCombinations::same(const AmbiguityDifferences& differences,
                            const DifferenceValues& given) const {
  const std::vector<IntegerCandidate>& candidates = differences.candidates();
  const std::size_t width = ambiguities_of_one * satellites_.size();
  int count = 0;
  for (std::size_t j = 0; j < integers_.size(); ++j) {
    const std::span<const double> all = std::span(shares_).subspan(j * width, width);
    Lambda::Vector z = Lambda::Vector::Zero(given.values.size());
    bool comparable = true;
    for (std::size_t s = 0; s < satellites_.size() && comparable; ++s) {
      const auto own = all.subspan(ambiguities_of_one * s, ambiguities_of_one);
      if (std::all_of(own.begin(), own.end(), [](double share) { return share == 0.0; })) continue;
      const auto of_this = [&](const auto& c) { return c.satellite == satellites_[s]; };
      const auto found = std::find_if(candidates.begin(), candidates.end(), of_this);
      comparable = found != candidates.end();
      // The share of a reference follows from the others.
      if (!comparable || !found->differenced()) continue;
      for (std::size_t which = 0; which < ambiguities_of_one; ++which)
        z[found->difference + static_cast<Eigen::Index>(which)] = own[which];
    }
    if (!comparable || z.dot(given.covariance * z) > integer_sigma * integer_sigma) continue;
    if (std::abs(z.dot(given.values) - integers_[j]) > integer_distance) return -1;
    ++count;
  }
  return count;
}

void FixedCombinations::forget(Satellite satellite) {
  for (Satellite& s : satellites_) {
    if (s == satellite)
      s = {};  // no satellite has the number 0: what it is in compares with nothing
  }
}

}  // namespace maploop::ppp
