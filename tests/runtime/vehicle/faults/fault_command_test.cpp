// Tests `maploop replay --fault` as a user types it.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(FaultCommand, WhatAFaultStruckAndWhatWasRefusedIsReported) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  const ProcessResult result = run({testing::maploop_command(), "replay", "--fault", "nan@imu:5:1",
                                    "--fault", "lost@camera:100", drive_0013().string(),
                                    "--lockstep", "--no-lcm", "--verbose", "--json", file});
  EXPECT_EQ(result.status, 0) << result.error;
  const auto r = nlohmann::json::parse(std::ifstream(file));
  EXPECT_EQ(r["faults"][0]["fault"], "nan@imu:5:1");
  EXPECT_GT(r["faults"][0]["struck"], 5);
  EXPECT_EQ(r["refusals"]["fusion"]["a value is not finite"], r["faults"][0]["struck"]);
  EXPECT_EQ(r["faults"][1]["struck"], 0);
  EXPECT_THAT(result.out, HasSubstr("outside of the drive"));
  EXPECT_THAT(result.out, HasSubstr("a value is not finite"));
}

TEST(FaultCommand, AWrongFaultIsAnErrorBeforeAnythingRuns) {
  const ProcessResult result =
      run({testing::maploop_command(), "replay", "/nonexistent", "--fault", "lots@camera"});
  EXPECT_NE(result.status, 0);
  EXPECT_THAT(result.error, HasSubstr("'lots' is not a kind of fault"));
  EXPECT_THAT(result.error, Not(HasSubstr("/nonexistent")));
}

}  // namespace
}  // namespace maploop::testing
