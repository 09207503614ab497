#include "tools/analyze/execution_bound.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace maploop::analyze {
namespace {

constexpr std::uint64_t enough = 30;

struct Excess {
  double value = 0.0;  // ms above the threshold
  double count = 0.0;
};

// The tail above a threshold: share of all that exceed it, and by how much.
struct Tail {
  double threshold = 0.0;  // ms
  double share = 0.0;
  std::vector<Excess> excesses;
  double count = 0.0;
};

Tail tail_of(const LatencySummary& s) {
  Tail tail;
  tail.threshold = to_milliseconds(s.p90);
  for (const HistogramData::Bucket& bucket : s.histogram.buckets) {
    const double value = to_milliseconds(bucket.lowest) - tail.threshold;
    if (value <= 0.0) continue;
    tail.excesses.push_back({value, static_cast<double>(bucket.count)});
    tail.count += static_cast<double>(bucket.count);
  }
  tail.share = s.count > 0 ? tail.count / static_cast<double>(s.count) : 0.0;
  return tail;
}

// A generalized Pareto distribution of excesses.
struct Pareto {
  double shape = 0.0;
  double scale = 1.0;  // ms

  double exceeded(double value) const {
    if (std::abs(shape) < 1e-9) return std::exp(-value / scale);
    return std::pow(std::max(0.0, 1.0 + shape * value / scale), -1.0 / shape);
  }
  // Returns the excess that is exceeded with a probability.
  double quantile(double probability) const {
    if (std::abs(shape) < 1e-9) return -scale * std::log(probability);
    return scale / shape * (std::pow(probability, -shape) - 1.0);
  }
};

Pareto fit(const Tail& tail) {
  double mean = 0.0, square = 0.0;
  for (const Excess& e : tail.excesses) {
    mean += e.count * e.value / tail.count;
    square += e.count * e.value * e.value / tail.count;
  }
  const double variance = std::max(square - mean * mean, 1e-12);
  const double ratio = mean * mean / variance;
  return {0.5 * (1.0 - ratio), 0.5 * mean * (1.0 + ratio)};
}

double distance(const Tail& tail, const Pareto& pareto) {
  double longer = tail.count, largest = 0.0;
  for (const Excess& e : tail.excesses) {
    const double expected = pareto.exceeded(e.value);
    largest = std::max(largest, std::abs(longer / tail.count - expected));
    longer -= e.count;
    largest = std::max(largest, std::abs(longer / tail.count - expected));
  }
  return largest;
}

}  // namespace

ExecutionBound execution_bound(const LatencySummary& execution, const BoundParameters& parameters) {
  ExecutionBound bound;
  bound.observed = to_milliseconds(execution.max);
  bound.bound = parameters.margin * bound.observed;
  const Tail tail = tail_of(execution);
  bound.exceedances = static_cast<std::uint64_t>(tail.count);
  if (bound.exceedances < enough || tail.excesses.size() < 3) return bound;
  const Pareto pareto = fit(tail);
  bound.distance = distance(tail, pareto);
  bound.fitted = bound.distance < 1.36 / std::sqrt(tail.count);
  if (bound.fitted) {
    bound.bound = std::max(bound.observed,
                           tail.threshold + pareto.quantile(parameters.probability / tail.share));
  }
  return bound;
}

}  // namespace maploop::analyze
