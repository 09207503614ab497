// This is zero-order Takagi-Sugeno-Kang inference.
//
// A rule's weight is the smallest membership of its conditions; the output is the mean of the
// rules' constants with these weights. A system is immutable after construction, so any number of
// threads may evaluate it at the same time. Evaluation does not allocate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "msgs/map_match.h"

namespace maploop::mapmatch {

struct MembershipFunction {
  enum class Shape : std::uint8_t {
    sigmoid,    // 1 / (1 + exp(-b (x - a)))
    ramp,       // 0 at a, 1 at b, linear between
    triangle,   // 0 at a and c, 1 at b
    trapezoid,  // 0 at a and d, 1 from b to c
  };
  Shape shape = Shape::sigmoid;
  std::array<double, 4> parameters{};  // a to d, as many as the shape needs

  double operator()(double x) const;
};

struct FuzzyTerm {
  std::string name;
  MembershipFunction membership;
};

struct FuzzyVariable {
  std::string name;
  std::vector<FuzzyTerm> terms;
};

struct FuzzyCondition {
  std::size_t variable = 0, term = 0;
};

struct FuzzyRule {
  std::vector<FuzzyCondition> conditions;  // all must hold
  double output = 0.0;
  std::string text;  // as written in the file
};

class FuzzySystem {
 public:
  static constexpr std::size_t max_rules = MatchCandidate::max_rules;
  static constexpr std::size_t max_terms = 48;  // total over all variables

  struct Result {
    bool decided = false;  // false if no rule applies (the sum of weights is below 1e-6)
    double value = 0.0;
    std::array<float, max_rules> weights{};  // by rule
  };

  // Throws std::invalid_argument if there are more rules or terms than the limits, no rule, or a
  // condition on a missing variable or term.
  FuzzySystem(std::vector<FuzzyVariable> variables, std::vector<FuzzyRule> rules);

  const std::vector<FuzzyVariable>& variables() const { return variables_; }
  const std::vector<FuzzyRule>& rules() const { return rules_; }

  // Takes one value per variable, in their order. A NaN means unknown: the rules that use this
  // variable do not take part.
  Result evaluate(std::span<const double> inputs) const;

 private:
  std::vector<FuzzyVariable> variables_;
  std::vector<FuzzyRule> rules_;
  std::vector<std::size_t> first_term_;  // index of each variable's first term among all terms
};

}  // namespace maploop::mapmatch
