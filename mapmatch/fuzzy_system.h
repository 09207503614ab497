// This is fuzzy inference: Takagi-Sugeno-Kang of order zero or one, or Mamdani.
//
// The strength of a rule is the smallest membership of its conditions, times the weight that the
// file gives it. After Takagi and Sugeno the output is the mean of the rules' values with these
// strengths; a value is a constant, or linear in the inputs. After Mamdani the strength cuts off
// the rule's fuzzy conclusion, and the output is the centroid of the union of all. A system is
// immutable after construction, so any number of threads may evaluate it at the same time.
// Evaluation does not allocate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
  double output = 0.0;                     // the value after Takagi and Sugeno
  std::vector<double> slopes{};            // of the value, by variable; none: it is constant
  MembershipFunction conclusion{};         // after Mamdani
  double weight = 1.0;                     // not negative; 0: the rule does not take part
  std::string text;                        // as written in the file
};

// The centroid after Mamdani is a sum over the middles of equal steps from `low` to `high`.
struct Centroid {
  double low = 0.0, high = 0.0;
  std::size_t steps = 0;
};

class FuzzySystem {
 public:
  static constexpr std::size_t max_rules = MatchCandidate::max_rules;
  static constexpr std::size_t max_terms = 48;  // total over all variables
  static constexpr std::size_t max_steps = 1000;

  struct Result {
    bool decided = false;  // false if no rule applies (the strengths add up to less than 1e-6)
    double value = 0.0;
    std::array<float, max_rules> weights{};  // the strengths, by rule
  };

  // With a centroid the inference is Mamdani's. Throws std::invalid_argument if there are more
  // rules, terms or steps than the limits, no rule, a weight below 0, a condition on a missing
  // variable or term, slopes for some of the variables only, or a centroid without range.
  FuzzySystem(std::vector<FuzzyVariable> variables, std::vector<FuzzyRule> rules,
              std::optional<Centroid> centroid = {});

  const std::vector<FuzzyVariable>& variables() const { return variables_; }
  const std::vector<FuzzyRule>& rules() const { return rules_; }
  const std::optional<Centroid>& centroid() const { return centroid_; }

  // Takes one value per variable, in their order. A NaN means unknown: the rules that use this
  // variable do not take part.
  Result evaluate(std::span<const double> inputs) const;

 private:
  using Strengths = std::array<double, max_rules>;

  void infer_mean(std::span<const double> inputs, const Strengths& strengths, Result& result) const;
  void infer_centroid(const Strengths& strengths, Result& result) const;

  std::vector<FuzzyVariable> variables_;
  std::vector<FuzzyRule> rules_;
  std::optional<Centroid> centroid_;
  std::vector<std::size_t> first_term_;  // index of each variable's first term among all terms
};

}  // namespace maploop::mapmatch
