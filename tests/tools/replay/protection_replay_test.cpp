// Tests the protection levels of replays, as a user runs them.
#include <nlohmann/json.hpp>

#include "tests/support/command_test.h"
#include "tests/support/real_data.h"

namespace maploop::protection_replay_test {
namespace {

using namespace maploop::testing;

class ProtectionReplay : public CommandTest {};

// GNSS is lost for the last minute of the drive. Where it had pulled the position away, and was
// doubted, no later fix says that the position is good again.
TEST_F(ProtectionReplay, DoubtedFixesLeaveThePositionDoubtedWhenTheyEnd) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const std::string drive = (real_data() / "kitti_odometry/oxts/06.csv.gz").string();
  const auto levels = [&](const Words& fault) {
    Words words{"replay", drive,  "--lockstep",    "--no-lcm", "--json",          file("run.json"),
                "--imu",  "mems", "--gnss-outage", "53:60",    "--configuration", "GNSS+RISS"};
    words.insert(words.end(), fault.begin(), fault.end());
    EXPECT_EQ(run_maploop(words).status, 0);
    return nlohmann::json::parse(read_file(file("run.json")))["protection"];
  };
  const auto sound = levels({});
  EXPECT_EQ(sound["doubted"], 0);
  EXPECT_EQ(sound["horizontal"]["beyond"], 0);
  const auto pulled = levels({"--fault", "drift@gnss:15"});
  EXPECT_GT(pulled["doubted"], 600) << "ten a second";
  EXPECT_EQ(pulled["horizontal"]["beyond"], 0);
}

}  // namespace
}  // namespace maploop::protection_replay_test
