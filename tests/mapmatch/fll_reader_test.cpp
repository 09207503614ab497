#include "mapmatch/fll_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

namespace maploop::mapmatch {
namespace {

constexpr std::array<std::string_view, 2> inputs{"b", "a"};

const std::string good =
    "Engine: small\n"                                       // 1
    "InputVariable: a  # a comment\n"                       // 2
    "  range: 0 10\n"                                       // 3
    "  term: low Ramp 10 0\n"                               // 4
    "InputVariable: b\n"                                    // 5
    "  term: high Sigmoid 5 1\n"                            // 6
    "OutputVariable: out\n"                                 // 7
    "  aggregation: none\n"                                 // 8
    "  defuzzifier: WeightedAverage TakagiSugeno\n"         // 9
    "  term: bad Constant 10\n"                             // 10
    "RuleBlock: all\r\n"                                    // 11
    "  conjunction: Minimum\n"                              // 12
    "  rule: if a is low and b is high then out is bad\n";  // 13

std::string refusal(const std::string& from, const std::string& to) {
  std::string text = good;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  try {
    parse_fll(text, "small.fll", inputs);
    return "accepted";
  } catch (const FllError& e) {
    return e.what();
  }
}

TEST(FllReader, ReadsARuleBaseAndTakesValuesInTheOrderAskedFor) {
  const FuzzySystem system = parse_fll(good, "small.fll", inputs);
  EXPECT_EQ(system.variables()[0].name, "b");
  EXPECT_EQ(system.variables()[1].name, "a");
  const auto result = system.evaluate(std::array{100.0, 2.5});
  EXPECT_TRUE(result.decided);
  EXPECT_FLOAT_EQ(result.weights[0], 0.75f);
  EXPECT_DOUBLE_EQ(result.value, 10.0);
}

TEST(FllReader, EveryMistakeIsRefusedWithFileAndLine) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal("a is low", "a is lwo"),
              HasSubstr("small.fll:13: 'lwo' is not a term of 'a'"));
  EXPECT_THAT(refusal("if a is", "if c is"),
              HasSubstr("small.fll:13: 'c' is not an input variable"));
  EXPECT_THAT(refusal("out is bad", "out is worse"), HasSubstr("small.fll:13: 'worse'"));
  EXPECT_THAT(refusal("then out", "then ouch"), HasSubstr("'ouch' is not the output"));
  EXPECT_EQ(refusal("is bad", "is bad with 0.5"), "accepted");
  EXPECT_THAT(refusal("is bad", "is bad with"), HasSubstr("may follow"));
  EXPECT_THAT(refusal("is bad", "is bad with -1"), HasSubstr("small.fll:13: a weight"));
  EXPECT_THAT(refusal("is bad", "is bad with half"), HasSubstr("'half' is not a finite number"));
  EXPECT_THAT(refusal("and b", "or b"), HasSubstr("small.fll:13: 'and' or 'then'"));
  EXPECT_THAT(refusal("and b is high", "and b is not high"), HasSubstr("small.fll:13"));
  EXPECT_THAT(refusal("if a is low and b is high then out is bad", "if"), HasSubstr("a condition"));
  EXPECT_THAT(refusal("if a is low and b is high then out is bad", ""),
              HasSubstr("must start with 'if'"));
  EXPECT_THAT(refusal(" then out is bad", ""), HasSubstr("small.fll:13"));
  EXPECT_THAT(refusal("high then out is bad", "high then"), HasSubstr("small.fll:13"));
  EXPECT_THAT(refusal("high then out is bad", "high and"), HasSubstr("small.fll:13"));
  EXPECT_THAT(refusal("Ramp 10 0", "Ramp 10"),
              HasSubstr("small.fll:4: 2 numbers are needed, but 1"));
  EXPECT_THAT(refusal("Ramp 10 0", "Ramp 10 nan"), HasSubstr("'nan' is not a finite number"));
  EXPECT_THAT(refusal("Ramp 10 0", "Slope 10 0"), HasSubstr("'Slope' is not Sigmoid"));
  EXPECT_THAT(refusal("Ramp 10 0", "Triangle 3 2 1"), HasSubstr("ascending order"));
  EXPECT_THAT(refusal("InputVariable: b", "InputVariable: bb"), HasSubstr("small.fll:5: 'bb'"));
  EXPECT_THAT(refusal("InputVariable: b", "InputVariable: a"), HasSubstr("defined twice"));
  EXPECT_THAT(refusal("InputVariable: b\n  term: high Sigmoid 5 1\n", ""),
              HasSubstr("'b' is not an input variable"));
  EXPECT_EQ(refusal("Constant 10", "Linear 1 2 3"), "accepted");
  EXPECT_THAT(refusal("Constant 10", "Linear 1 2"), HasSubstr("small.fll:10: 3 numbers"));
  EXPECT_THAT(refusal("bad Constant 10", "bad"), HasSubstr("small.fll:10: an output term"));
  EXPECT_THAT(refusal("Constant 10", "Constance 10"), HasSubstr("'Constance' is not Sigmoid"));
  EXPECT_THAT(refusal("Constant 10", "Ramp 0 1"), HasSubstr("does not suit the defuzzifier"));
  const std::string mean = "WeightedAverage TakagiSugeno";
  EXPECT_THAT(refusal(mean, "Centroid 100"), HasSubstr("does not suit the defuzzifier"));
  EXPECT_THAT(refusal(mean, "Centroid 0"), HasSubstr("small.fll:9: a centroid has 1 to 1000"));
  EXPECT_THAT(refusal(mean, "Centroid 1.5"), HasSubstr("a centroid has 1 to 1000 steps"));
  EXPECT_THAT(refusal(mean, "Bisector 100"), HasSubstr("'defuzzifier' can only be"));
  EXPECT_THAT(refusal("Minimum", "AlgebraicProduct"), HasSubstr("small.fll:12: 'conjunction'"));
  EXPECT_THAT(refusal("range: 0 10", "ragne: 0 10"),
              HasSubstr("small.fll:3: 'ragne' is not known"));
  EXPECT_THAT(refusal("Engine: small\n", ""), HasSubstr("must start with 'Engine"));
  EXPECT_THAT(refusal("RuleBlock: all", "RuleBlock"), HasSubstr("small.fll:11: a line must be"));
  EXPECT_THAT(refusal("  rule: if a is low and b is high then out is bad\n", ""),
              HasSubstr("no rule"));
}

TEST(FllReader, StopsAtTheFirstTermOrRuleTooMany) {
  std::string terms, rules, results;
  for (int i = 0; i < 1000; ++i) {
    terms += "  term: t" + std::to_string(i) + " Ramp 10 0\n";
    results += "  term: t" + std::to_string(i) + " Constant 10\n";
    rules += "  rule: if a is low and b is high then out is bad\n";
  }
  EXPECT_THAT(refusal("  term: low", terms + "  term: low"),
              ::testing::HasSubstr("small.fll:52: more than 48 terms"));
  EXPECT_THAT(refusal("  term: bad", results + "  term: bad"),
              ::testing::HasSubstr(": more than 48 terms"));
  EXPECT_THAT(refusal("  rule:", rules + "  rule:"),
              ::testing::HasSubstr("small.fll:45: more than 32 rules"));
}

TEST(FllReader, AFileThatIsNotThereIsNamed) {
  try {
    read_fll("/nowhere/rules.fll", inputs);
    FAIL();
  } catch (const FllError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("/nowhere/rules.fll"));
  }
}

}  // namespace
}  // namespace maploop::mapmatch
