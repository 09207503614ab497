// Tests the real-time settings that `maploop doctor` and `maploop replay` report.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/core/realtime_scheduling.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using nlohmann::json;

// Returns the settings that the command writes, by name.
json settings_of(std::vector<std::string> command, const char* key) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "report.json").string();
  command.insert(command.end(), {"--json", file});
  const testing::ProcessResult result = testing::run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  json by_name = json::object();
  const json report = json::parse(std::ifstream(file));
  for (const json& setting : report.at(key)) {
    by_name[setting.at("name")] = setting;
    EXPECT_EQ(setting.at("verdict") == "granted", setting.at("remedy") == "") << setting;
  }
  return by_name;
}

// Runs the command as root without any capability, which gives it the rights of an ordinary user.
std::vector<std::string> without_capabilities(std::vector<std::string> command) {
  command.insert(command.begin(), {"setpriv", "--bounding-set=-all", "--inh-caps=-all", "prlimit",
                                   "--rtprio=0", "--memlock=1000000"});
  return command;
}

bool can_drop_capabilities() {
  return testing::run(without_capabilities({"true"})).status == 0;
}

TEST(DoctorCommand, NamesEveryThreadAndTheMachine) {
  const json settings = settings_of({testing::maploop_command(), "doctor"}, "settings");
  for (const char* name : {"heap", "locked memory", "kernel", "camera: scheduling",
                           "fusion: scheduling", "fusion: stack", "health: scheduling"}) {
    EXPECT_TRUE(settings.contains(name)) << name;
  }
  EXPECT_EQ(settings["fusion: scheduling"]["asked"], "fifo 60");
}

TEST(DoctorCommand, AsksForWhatTheConfigurationSays) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "a.toml").string();
  std::ofstream(file) << "[scheduling.fusion]\npolicy = \"rr\"\npriority = 7\ncpus = [0]\n"
                         "[memory]\nlock_memory = false\n";
  const json settings =
      settings_of({testing::maploop_command(), "doctor", "--config", file}, "settings");
  EXPECT_EQ(settings["fusion: scheduling"]["asked"], "rr 7");
  EXPECT_EQ(settings["fusion: CPUs"]["asked"], "0");
  EXPECT_FALSE(settings.contains("locked memory"));
}

TEST(DoctorCommand, SaysWhatIsRefusedWhyAndWhatToDo) {
  if (!can_drop_capabilities()) GTEST_SKIP() << "setpriv cannot drop capabilities here";
  const json settings =
      settings_of(without_capabilities({testing::maploop_command(), "doctor"}), "settings");
  for (const char* name : {"fusion: scheduling", "locked memory"}) {
    EXPECT_EQ(settings[name]["verdict"], "refused") << settings[name];
    EXPECT_NE(settings[name]["reason"], "");
  }
  EXPECT_EQ(settings["fusion: scheduling"]["granted"], runtime::read_scheduling().policy);
}

TEST(DoctorCommand, AReplayWithoutPrivilegesSaysSoAndHasTheSameBits) {
  MAPLOOP_REQUIRE_DRIVE();
  if (!can_drop_capabilities()) GTEST_SKIP() << "setpriv cannot drop capabilities here";
  const testing::TemporaryFolder folder;
  const auto replay = [&](const char* option, bool privileged) {
    const std::string file = (folder.path() / "result.json").string();
    std::vector<std::string> command{testing::maploop_command(),
                                     "replay",
                                     testing::drive_0013().string(),
                                     "--no-lcm",
                                     "--end",
                                     "3",
                                     "--json",
                                     file};
    if (*option != '\0') command.emplace_back(option);
    const testing::ProcessResult result =
        testing::run(privileged ? command : without_capabilities(command));
    EXPECT_EQ(result.status, 0) << result.error;
    json read = json::parse(std::ifstream(file));
    read["said"] = result.error;
    return read;
  };
  const json refused = replay("", false);
  // The test's own policy, which the command inherits: "other", or "other nice 19".
  const std::string inherited = runtime::read_scheduling().policy;
  EXPECT_NE(refused["said"].get<std::string>().find("refused   fusion: scheduling: " + inherited +
                                                    ", not fifo"),
            std::string::npos)
      << refused["said"];
  EXPECT_NE(refused["degraded"].dump().find("fusion: scheduling is " + inherited + ", not fifo 60"),
            std::string::npos);
  const json lockstep = replay("--lockstep", true);
  EXPECT_EQ(refused["channels"]["NAV_STATE"], lockstep["channels"]["NAV_STATE"]);
  EXPECT_EQ(lockstep["said"], "") << "virtual time asks for nothing";
}

}  // namespace
}  // namespace maploop
