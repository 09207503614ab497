// These tests compare the rule bases with values computed by hand and with the fuzzylite library.
#include "mapmatch/fuzzy_system.h"

#include <fl/Headers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "mapmatch/fll_reader.h"
#include "mapmatch/rule_bases.h"
#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "tests/mapmatch/default_rule_bases.h"
#include "tests/support/counted_allocations.h"

namespace maploop::mapmatch {
namespace {

using Inputs = std::vector<double>;
using maploop::testing::rules;

// The values of the method are those of the published rules, which have no weights.
double value_without_weights(const FuzzySystem& system, const Inputs& inputs) {
  std::vector<FuzzyRule> rules = system.rules();
  for (FuzzyRule& rule : rules) rule.weight = 1.0;
  return FuzzySystem(system.variables(), std::move(rules)).evaluate(inputs).value;
}

TEST(RuleBases, InitialMatchingHasTheValuesOfTheMethod) {
  const std::vector<std::pair<Inputs, double>> vectors{
      {{10, 5, 5, 1.5}, 66.6508},   {{10, 90, 5, 1.5}, 29.9762}, {{10, 5, 45, 1.5}, 30.5541},
      {{10, 90, 45, 1.5}, 10.0299}, {{0.5, 5, 5, 1.5}, 74.9947}, {{10, 30, 20, 1.5}, 64.5116},
      {{4.5, 32.5, 25, 4}, 61.3043}};
  for (const auto& [inputs, expected] : vectors)
    EXPECT_NEAR(value_without_weights(rules().initial, inputs), expected, 5e-5);
}

TEST(RuleBases, AlongALinkHasTheValuesOfTheMethodWithAndWithoutVision) {
  struct Vector {
    Inputs inputs;
    double plain, visual;
  };
  const std::vector<Vector> vectors{{{12, 1.5, 5, 5, -80, 2, .5}, 74.9972, 74.9981},
                                    {{12, 1.5, 5, 175, 20, 2, .5}, 20.0009, 23.3341},
                                    {{8, 1.5, 20, 60, 0, 40, 20}, 17.4690, 15.4382},
                                    {{0, 1.5, 10, 10, -80, 1, .1}, 87.4678, 91.6383},
                                    {{8, 1.5, 20, 20, -60, 180, 25}, 42.4997, 46.6663},
                                    {{8, 1.5, 30, 150, 25, 60, 25}, 10.0000, 10.0000}};
  for (const Vector& v : vectors) {
    EXPECT_NEAR(value_without_weights(rules().along, v.inputs), v.plain, 5e-5);
    Inputs visual = v.inputs;
    visual.insert(visual.end(), {v.inputs[0], v.inputs[5]});
    EXPECT_NEAR(rules().along_visual.evaluate(visual).value, v.visual, 5e-5);
  }
  EXPECT_EQ(rules().along.rules().size(), 13u);
  EXPECT_EQ(rules().along_visual.rules().size(), 20u);
}

TEST(RuleBases, JunctionHasTheValuesOfTheMethod) {
  const std::vector<std::pair<Inputs, double>> vectors{{{10, 5, 5, 1.5, 1, 3}, 79.9933},
                                                       {{10, 80, 20, 1.5, 1, 8}, 64.0834},
                                                       {{10, 5, 30, 1.5, 0, 40}, 27.8601},
                                                       {{10, 40, 15, 1.5, 1, 12}, 67.2442}};
  for (const auto& [inputs, expected] : vectors)
    EXPECT_NEAR(value_without_weights(rules().junction, inputs), expected, 5e-5);
}

// Compares random inputs with the fuzzylite library, an independent program that reads the same
// text, of which `names` are the input variables.
void expect_fuzzylite_agrees(const std::string& text, std::span<const std::string_view> names) {
  fl::fuzzylite::setMachEps(0.0);  // it would ignore rules of strengths below 1e-6
  const FuzzySystem system = parse_fll(text, "rules", names);
  const std::unique_ptr<fl::Engine> engine(fl::FllImporter().fromString(text));
  std::mt19937 random(11);
  int decided = 0;
  for (int i = 0; i < 300; ++i) {
    Inputs inputs;
    for (const FuzzyVariable& v : system.variables()) {
      const bool wide = v.name.find("overshoot") != std::string::npos;
      const double high = v.name == "connectivity"                    ? 1.0
                          : v.name == "hdop"                          ? 8.0
                          : v.name.find("speed") != std::string::npos ? 12.0
                          : v.name == "turn_rate"                     ? 15.0
                                                                      : 180.0;
      inputs.push_back(
          std::uniform_real_distribution<double>(wide ? -40.0 : 0.0, wide ? 40.0 : high)(random));
      engine->setInputValue(v.name, inputs.back());
    }
    engine->process();
    const auto ours = system.evaluate(inputs);
    if (!ours.decided) continue;
    ++decided;
    EXPECT_NEAR(ours.value, engine->getOutputVariable(0)->getValue(), 1e-9) << text.substr(0, 40);
  }
  EXPECT_GE(decided, 200);
}

TEST(RuleBases, FuzzyliteAgreesOnEachFile) {
  const auto text = [](const char* file) {
    return read_text(default_rules() / file, input_limits::settings);
  };
  expect_fuzzylite_agrees(text("initial_matching.fll"), initial_inputs);
  expect_fuzzylite_agrees(text("along_link.fll"), along_inputs);
  expect_fuzzylite_agrees(text("along_link_visual.fll"), visual_along_inputs);
  expect_fuzzylite_agrees(text("junction.fll"), junction_inputs);
}

const std::string two_inputs =
    "Engine: two\n"
    "InputVariable: distance\n"
    "  range: 0 180\n"
    "  term: short Ramp 40 10\n"
    "  term: long Sigmoid 30 0.2\n"
    "InputVariable: speed\n"
    "  range: 0 20\n"
    "  term: slow Triangle 0 3 9\n"
    "  term: fast Trapezoid 2 8 20 20\n"
    "OutputVariable: likelihood\n"
    "  range: 0 100\n";
const std::string three_rules =
    "RuleBlock: rules\n"
    "  conjunction: Minimum\n"
    "  implication: Minimum\n"
    "  activation: General\n"
    "  rule: if distance is short and speed is fast then likelihood is high\n"
    "  rule: if distance is long then likelihood is low with 0.6\n"
    "  rule: if speed is slow then likelihood is average with 0.25\n";
const std::string first_order = two_inputs +
                                "  aggregation: none\n"
                                "  defuzzifier: WeightedAverage TakagiSugeno\n"
                                "  term: low Constant 10\n"
                                "  term: average Linear 0 2 40\n"
                                "  term: high Linear -0.5 1 90\n" +
                                three_rules;
const std::string mamdani = two_inputs +
                            "  aggregation: Maximum\n"
                            "  defuzzifier: Centroid 100\n"
                            "  term: low Ramp 40 0\n"
                            "  term: average Triangle 20 50 80\n"
                            "  term: high Sigmoid 75 0.2\n" +
                            three_rules;
constexpr std::array<std::string_view, 2> speed_first{"speed", "distance"};

TEST(FuzzySystem, FuzzyliteAgreesOnFirstOrderAndOnMamdani) {
  expect_fuzzylite_agrees(first_order, speed_first);
  expect_fuzzylite_agrees(mamdani, speed_first);
}

TEST(FuzzySystem, ALinearValueOfWhatIsNotKnownDoesNotTakePart) {
  const FuzzySystem system = parse_fll(first_order, "first", speed_first);
  const auto result = system.evaluate(Inputs{std::nan(""), 100.0});
  ASSERT_TRUE(result.decided);
  EXPECT_DOUBLE_EQ(result.value, 10.0) << "only the rule of long distances is left";
}

TEST(FuzzySystem, ACentroidWithoutAnyStrengthIsUndecided) {
  const FuzzySystem system = parse_fll(mamdani, "mamdani", speed_first);
  EXPECT_FALSE(system.evaluate(Inputs{std::nan(""), std::nan("")}).decided);
}

TEST(FuzzySystem, WhatCannotBeIsRefused) {
  const FuzzySystem good = parse_fll(mamdani, "mamdani", speed_first);
  std::vector<FuzzyRule> rules = good.rules();
  const auto build = [&](std::optional<Centroid> centroid) {
    return FuzzySystem(good.variables(), rules, centroid);
  };
  EXPECT_NO_THROW(build(Centroid{0.0, 100.0, 10}));
  EXPECT_THROW(build(Centroid{0.0, 100.0, 0}), std::invalid_argument);
  EXPECT_THROW(build(Centroid{0.0, 100.0, 100000}), std::invalid_argument);
  EXPECT_THROW(build(Centroid{5.0, 5.0, 10}), std::invalid_argument);
  rules[0].slopes = {1.0};
  EXPECT_THROW(build({}), std::invalid_argument);
  rules[0].slopes.clear();
  rules[0].weight = -1.0;
  EXPECT_THROW(build({}), std::invalid_argument);
}

TEST(FuzzySystem, RulesThatAskForWhatIsNotKnownDoNotTakePart) {
  const double unknown = std::nan("");
  const auto standing = rules().initial.evaluate(Inputs{0.5, unknown, 5, 1.5});
  ASSERT_TRUE(standing.decided);
  EXPECT_NEAR(standing.value, 50.0, 0.2) << "only the rules of distance are left";
  EXPECT_EQ(standing.weights[4], 0.0f);
  EXPECT_FALSE(rules().initial.evaluate(Inputs{unknown, unknown, unknown, unknown}).decided);
}

TEST(FuzzySystem, MembershipFunctions) {
  using Shape = MembershipFunction::Shape;
  const MembershipFunction ramp{Shape::ramp, {1.0, 0.0}};
  EXPECT_DOUBLE_EQ(ramp(0.25), 0.75);
  EXPECT_DOUBLE_EQ(ramp(-1.0), 1.0);
  const MembershipFunction trapezoid{Shape::trapezoid, {125, 150, 200, 225}};
  EXPECT_DOUBLE_EQ(trapezoid(137.5), 0.5);
  EXPECT_DOUBLE_EQ(trapezoid(180), 1.0);
  EXPECT_DOUBLE_EQ(trapezoid(230), 0.0);
  const MembershipFunction triangle{Shape::triangle, {0, 1, 3}};
  EXPECT_DOUBLE_EQ(triangle(1), 1.0);
  EXPECT_DOUBLE_EQ(triangle(2), 0.5);
  const MembershipFunction step{Shape::triangle, {1, 1, 1}};
  EXPECT_DOUBLE_EQ(step(1), 1.0);
  EXPECT_DOUBLE_EQ(step(0.5), 0.0);
}

TEST(FuzzySystem, EvaluatingAllocatesNothing) {
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const Inputs inputs{12, 1.5, 5, 5, -80, 2, .5, 12, 2};
  const RuleBases& bases = rules();
  const long before = maploop::testing::thread_allocations();
  double sum = 0.0;
  for (int i = 0; i < 100; ++i) sum += bases.along_visual.evaluate(inputs).value;
  EXPECT_EQ(maploop::testing::thread_allocations(), before);
  EXPECT_NEAR(sum, 7499.81, 0.01);
}

}  // namespace
}  // namespace maploop::mapmatch
