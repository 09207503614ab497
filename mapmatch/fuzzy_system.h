// Zero-order Takagi-Sugeno-Kang inference.
//
// A rule's weight is the smallest membership of its conditions; the output is the mean of the
// rules' constants, weighted so. Immutable once made: any number of threads may evaluate one system
// at the same time. Evaluating does not allocate.
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
    ramp,       // 0 at a, 1 at b, straight between
    triangle,   // 0 at a and c, 1 at b
    trapezoid,  // 0 at a and d, 1 from b to c
  };
  Shape shape = Shape::sigmoid;
  std::array<double, 4> parameters{};  // a to d, as many as the shape has

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
  std::vector<FuzzyCondition> conditions;  // all of them hold
  double output = 0.0;
  std::string text;  // as it is written
};

class FuzzySystem {
 public:
  static constexpr std::size_t max_rules = MatchCandidate::max_rules;
  static constexpr std::size_t max_terms = 48;  // of all variables together

  struct Result {
    bool decided = false;  // false where no rule applies (the weights' sum is below 1e-6)
    double value = 0.0;
    std::array<float, max_rules> weights{};  // by rule
  };

  // Throws std::invalid_argument: more rules or terms than the limits, none at all, or a condition
  // on what is not there.
  FuzzySystem(std::vector<FuzzyVariable> variables, std::vector<FuzzyRule> rules);

  const std::vector<FuzzyVariable>& variables() const { return variables_; }
  const std::vector<FuzzyRule>& rules() const { return rules_; }

  // One value a variable, in their order. A value that is not a number is not known: the rules that
  // ask for it do not take part.
  Result evaluate(std::span<const double> inputs) const;

 private:
  std::vector<FuzzyVariable> variables_;
  std::vector<FuzzyRule> rules_;
  std::vector<std::size_t> first_term_;  // of a variable, among all terms
};

}  // namespace maploop::mapmatch
