// Tests that the log of a car's tables is replayed as the tables are.
#include "tests/support/command_test.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using namespace testing;

using LogOfTables = CommandTest;

TEST_F(LogOfTables, HasTheBitsAndTheScoreOfTheTables) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto tables = real_data() / "cars/oakville/urban-short-turn-loop-nominal-002";
  if (!std::filesystem::exists(tables)) GTEST_SKIP() << "SKIPPED, NOT TESTED: no " << tables;
  const json whole =
      replay(tables.string(), {"--lockstep", "--end", "60", "--record", file("car.lcmlog")});
  const json log = replay(file("car.lcmlog"), {"--lockstep"});
  EXPECT_EQ(log["configuration"], "GNSS+RI");
  EXPECT_EQ(hashes(log).at("NAV_STATE"), hashes(whole).at("NAV_STATE"));
  EXPECT_EQ(log["verdict"][1], whole["verdict"][1]) << "the reference is a peer's";
}

}  // namespace
}  // namespace maploop
