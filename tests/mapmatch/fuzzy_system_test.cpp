// These tests compare the rule bases with values computed by hand and with the fuzzylite program.
#include "mapmatch/fuzzy_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "mapmatch/rule_bases.h"
#include "tests/mapmatch/default_rule_bases.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/process.h"

namespace maploop::mapmatch {
namespace {

using Inputs = std::vector<double>;
using maploop::testing::rules;

TEST(RuleBases, InitialMatchingHasTheValuesOfTheMethod) {
  const std::vector<std::pair<Inputs, double>> vectors{
      {{10, 5, 5, 1.5}, 66.6508},   {{10, 90, 5, 1.5}, 29.9762}, {{10, 5, 45, 1.5}, 30.5541},
      {{10, 90, 45, 1.5}, 10.0299}, {{0.5, 5, 5, 1.5}, 74.9947}, {{10, 30, 20, 1.5}, 64.5116},
      {{4.5, 32.5, 25, 4}, 61.3043}};
  for (const auto& [inputs, expected] : vectors)
    EXPECT_NEAR(rules().initial.evaluate(inputs).value, expected, 5e-5);
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
    EXPECT_NEAR(rules().along.evaluate(v.inputs).value, v.plain, 5e-5);
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
    EXPECT_NEAR(rules().junction.evaluate(inputs).value, expected, 5e-5);
}

// Compares random inputs with Debian's fuzzylite, an independent program that reads the same files.
void expect_fuzzylite_agrees(const FuzzySystem& system, const char* file) {
  if (maploop::testing::run({"which", "fuzzylite"}).status != 0)
    GTEST_SKIP() << "SKIPPED, NOT TESTED: the program fuzzylite is not installed";
  maploop::testing::TemporaryFolder folder;
  std::mt19937 random(11);
  std::vector<Inputs> all;
  std::ofstream data(folder.path() / "in.fld");
  data.precision(17);
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
      data << inputs.back() << ' ';
    }
    data << '\n';
    all.push_back(inputs);
  }
  data.close();
  // fuzzylite takes values in the order of the file, which equals that of the inputs.
  const auto result = maploop::testing::run(
      {"fuzzylite", "-i", (default_rules() / file).string(), "-of", "fld", "-o",
       (folder.path() / "out.fld").string(), "-d", (folder.path() / "in.fld").string(), "-decimals",
       "9", "-dinputs", "false", "-dheader", "false"});
  ASSERT_EQ(result.status, 0) << result.error;
  std::ifstream out(folder.path() / "out.fld");
  for (const Inputs& inputs : all) {
    std::string theirs;
    ASSERT_TRUE(out >> theirs) << file;
    // fuzzylite ignores rules whose weight is below 1e-6.
    const auto ours = system.evaluate(inputs);
    double sum = 0.0, weighted = 0.0;
    for (std::size_t r = 0; r < system.rules().size(); ++r) {
      const auto weight = static_cast<double>(ours.weights[r]);
      if (weight <= 1e-6) continue;
      sum += weight;
      weighted += weight * system.rules()[r].output;
    }
    if (sum == 0.0) {
      EXPECT_EQ(theirs, "nan");
      continue;
    }
    EXPECT_NEAR(weighted / sum, std::stod(theirs), 1e-3) << file;
    // The ignored rules can change our value by at most this bound.
    EXPECT_NEAR(ours.value, std::stod(theirs), 1e-3 + 90.0 * 32e-6 / sum) << file;
  }
}

TEST(RuleBases, FuzzyliteAgreesOnInitialMatching) {
  expect_fuzzylite_agrees(rules().initial, "initial_matching.fll");
}
TEST(RuleBases, FuzzyliteAgreesAlongALink) {
  expect_fuzzylite_agrees(rules().along, "along_link.fll");
}
TEST(RuleBases, FuzzyliteAgreesAlongALinkWithVision) {
  expect_fuzzylite_agrees(rules().along_visual, "along_link_visual.fll");
}
TEST(RuleBases, FuzzyliteAgreesAtAJunction) {
  expect_fuzzylite_agrees(rules().junction, "junction.fll");
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
