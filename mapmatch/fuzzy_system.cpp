#include "mapmatch/fuzzy_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace maploop::mapmatch {
namespace {

constexpr double min_strength = 1e-6;  // sum over all rules

// Returns the position of x between a and b as a share, limited to [0, 1]; a step if a equals b.
double rise(double x, double a, double b) {
  if (a == b) return x >= a ? 1.0 : 0.0;
  return std::clamp((x - a) / (b - a), 0.0, 1.0);
}

}  // namespace

double MembershipFunction::operator()(double x) const {
  const auto& [a, b, c, d] = parameters;
  switch (shape) {
    case Shape::sigmoid:
      return 1.0 / (1.0 + std::exp(-b * (x - a)));  // (12) of METHOD.md
    case Shape::ramp:
      return rise(x, a, b);
    case Shape::triangle:
      return x < b ? rise(x, a, b) : x == b ? 1.0 : rise(x, c, b);
    case Shape::trapezoid:
      return x < b ? rise(x, a, b) : x <= c ? 1.0 : rise(x, d, c);
  }
  return 0.0;
}

FuzzySystem::FuzzySystem(std::vector<FuzzyVariable> variables, std::vector<FuzzyRule> rules,
                         std::optional<Centroid> centroid)
    : variables_(std::move(variables)), rules_(std::move(rules)), centroid_(centroid) {
  std::size_t terms = 0;
  for (const FuzzyVariable& v : variables_) {
    first_term_.push_back(terms);
    terms += v.terms.size();
  }
  if (terms > max_terms)
    throw std::invalid_argument("more than " + std::to_string(max_terms) + " terms");
  if (rules_.empty()) throw std::invalid_argument("there are no rules");
  if (rules_.size() > max_rules)
    throw std::invalid_argument("more than " + std::to_string(max_rules) + " rules");
  for (const FuzzyRule& rule : rules_) {
    if (rule.conditions.empty()) throw std::invalid_argument("a rule has no condition");
    if (!(rule.weight >= 0.0)) throw std::invalid_argument("the weight of a rule is negative");
    if (!rule.slopes.empty() && rule.slopes.size() != variables_.size())
      throw std::invalid_argument("a linear term needs one slope for each input variable");
    for (const FuzzyCondition& c : rule.conditions) {
      if (c.variable >= variables_.size() || c.term >= variables_[c.variable].terms.size())
        throw std::invalid_argument("a rule uses a variable or a term that is not defined");
    }
  }
  if (centroid_ && (centroid_->steps == 0 || centroid_->steps > max_steps ||
                    !(centroid_->low < centroid_->high))) {
    throw std::invalid_argument("a centroid needs a range, and 1 to " + std::to_string(max_steps) +
                                " steps");
  }
}

FuzzySystem::Result FuzzySystem::evaluate(std::span<const double> inputs) const {
  std::array<double, max_terms> membership;
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const auto& terms = variables_[v].terms;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      membership[first_term_[v] + t] = std::isfinite(inputs[v])
                                           ? terms[t].membership(inputs[v])
                                           : std::numeric_limits<double>::quiet_NaN();
    }
  }
  Result result;
  Strengths strengths{};
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    double least = 1.0;
    for (const FuzzyCondition& c : rules_[r].conditions) {
      const double mu = membership[first_term_[c.variable] + c.term];
      least = std::isnan(mu) ? 0.0 : std::min(least, mu);
    }
    strengths[r] = rules_[r].weight * least;
    result.weights[r] = static_cast<float>(strengths[r]);
  }
  if (centroid_) {
    infer_centroid(strengths, result);
  } else {
    infer_mean(inputs, strengths, result);
  }
  return result;
}

void FuzzySystem::infer_mean(std::span<const double> inputs, const Strengths& strengths,
                             Result& result) const {
  double sum = 0.0, weighted = 0.0;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    double value = rules_[r].output;
    for (std::size_t v = 0; v < rules_[r].slopes.size(); ++v) {
      if (rules_[r].slopes[v] != 0.0) value += rules_[r].slopes[v] * inputs[v];
    }
    if (!std::isfinite(value)) {  // it depends on what is not known
      result.weights[r] = 0.0f;
      continue;
    }
    sum += strengths[r];
    weighted += strengths[r] * value;
  }
  result.decided = sum >= min_strength;
  if (result.decided) result.value = weighted / sum;  // (13) of METHOD.md
}

void FuzzySystem::infer_centroid(const Strengths& strengths, Result& result) const {
  const double step = (centroid_->high - centroid_->low) / static_cast<double>(centroid_->steps);
  double area = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < centroid_->steps; ++i) {
    const double x = centroid_->low + (static_cast<double>(i) + 0.5) * step;
    double height = 0.0;
    for (std::size_t r = 0; r < rules_.size(); ++r) {
      if (strengths[r] > height)
        height = std::max(height, std::min(strengths[r], rules_[r].conclusion(x)));
    }
    area += height;
    moment += height * x;
  }
  const double sum = std::accumulate(strengths.begin(), strengths.end(), 0.0);
  result.decided = sum >= min_strength && area > 0.0;
  if (result.decided) result.value = moment / area;  // (13) of METHOD.md
}

}  // namespace maploop::mapmatch
