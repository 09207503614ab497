// Tests `maploop experiment match` and `rules` on a short recorded drive.
#include "mapmatch/rule_bases.h"
#include "tests/support/command_test.h"

namespace maploop::testing {
namespace {

class MatchExperiment : public CommandTest {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }

  static ProcessResult experiment(const std::string& which, const Words& options) {
    Words words{"experiment",
                which,
                (real_data() / "maps/karlsruhe_2012-04.osm.pbf").string(),
                (real_data() / "kitti_odometry").string(),
                "--sequences",
                "04",
                "--seeds",
                "1"};
    words.insert(words.end(), options.begin(), options.end());
    return run_maploop(words);
  }
};

TEST_F(MatchExperiment, LearnsWeightsThatTheMatcherReads) {
  const ProcessResult learnt = experiment("rules", {"--learn", file("rules")});
  ASSERT_EQ(learnt.status, 0) << learnt.error;
  EXPECT_THAT(learnt.out, HasSubstr("if distance_error is large then likelihood is low"));
  for (const char* name :
       {"initial_matching.fll", "along_link.fll", "along_link_visual.fll", "junction.fll"}) {
    EXPECT_TRUE(std::filesystem::exists(file("rules") + "/" + name)) << name;
  }
  const ProcessResult matched =
      experiment("match", {"--rules", file("rules"), "--set", "paths=0", "--json", file("m.json")});
  ASSERT_EQ(matched.status, 0) << matched.error;
  EXPECT_GE(read_json(file("m.json"))["noise-free, 1 Hz"]["ours"]["all"]["right"], 0.9);
}

TEST_F(MatchExperiment, WeightsAreNotWrittenOverTheRules) {
  std::filesystem::create_directories(file("rules"));
  std::filesystem::copy(mapmatch::default_rules(), file("rules"));
  const ProcessResult result =
      experiment("rules", {"--rules", file("rules"), "--learn", file("rules")});
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.error, HasSubstr("name another folder"));
}

TEST_F(MatchExperiment, RulesThatAreNotThereAreNamed) {
  const ProcessResult result = experiment("match", {"--rules", file("none")});
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.error, HasSubstr("none"));
}

}  // namespace
}  // namespace maploop::testing
