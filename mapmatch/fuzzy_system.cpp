#include "mapmatch/fuzzy_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace maploop::mapmatch {
namespace {

constexpr double min_weight = 1e-6;  // sum over all rules

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

FuzzySystem::FuzzySystem(std::vector<FuzzyVariable> variables, std::vector<FuzzyRule> rules)
    : variables_(std::move(variables)), rules_(std::move(rules)) {
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
    for (const FuzzyCondition& c : rule.conditions) {
      if (c.variable >= variables_.size() || c.term >= variables_[c.variable].terms.size())
        throw std::invalid_argument("a rule uses a variable or a term that is not defined");
    }
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
  double sum = 0.0, weighted = 0.0;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    double weight = 1.0;
    for (const FuzzyCondition& c : rules_[r].conditions) {
      const double mu = membership[first_term_[c.variable] + c.term];
      weight = std::isnan(mu) ? 0.0 : std::min(weight, mu);
    }
    result.weights[r] = static_cast<float>(weight);
    sum += weight;
    weighted += weight * rules_[r].output;
  }
  result.decided = sum >= min_weight;
  if (result.decided) result.value = weighted / sum;  // (13) of METHOD.md
  return result;
}

}  // namespace maploop::mapmatch
