// Tests the real-time settings that `maploop doctor` and `maploop replay` report.
#include "runtime/core/realtime_scheduling.h"
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

// Returns the settings that the command writes, by name.
json settings_of(Words command) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "report.json";
  command.insert(command.end(), {"--json", file.string()});
  const ProcessResult result = run(command);
  EXPECT_EQ(result.status, 0) << result.error;
  json by_name = json::object();
  const json report = read_json(file);
  for (const json& setting : report.at("settings")) {
    by_name[setting.at("name")] = setting;
    EXPECT_EQ(setting.at("verdict") == "granted", setting.at("remedy").get<std::string>().empty())
        << setting;
  }
  return by_name;
}

// Runs the command as root without any capability, which gives it the rights of an ordinary user.
Words without_capabilities(Words command) {
  command.insert(command.begin(), {"setpriv", "--bounding-set=-all", "--inh-caps=-all", "prlimit",
                                   "--rtprio=0", "--memlock=1000000"});
  return command;
}

bool can_drop_capabilities() {
  return run(without_capabilities({"true"})).status == 0;
}

TEST(DoctorCommand, NamesEveryThreadAndTheMachine) {
  const json settings = settings_of({maploop_command(), "doctor"});
  for (const char* name : {"heap", "locked memory", "kernel", "camera: scheduling",
                           "fusion: scheduling", "fusion: stack", "health: scheduling"}) {
    EXPECT_TRUE(settings.contains(name)) << name;
  }
  EXPECT_EQ(settings["fusion: scheduling"]["asked"], "fifo 60");
}

TEST(DoctorCommand, AsksForWhatTheConfigurationSays) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.toml").string();
  std::ofstream(file) << "[scheduling.fusion]\npolicy = \"rr\"\npriority = 7\ncpus = [0]\n"
                         "[memory]\nlock_memory = false\n";
  const json settings = settings_of({maploop_command(), "doctor", "--config", file});
  EXPECT_EQ(settings["fusion: scheduling"]["asked"], "rr 7");
  EXPECT_EQ(settings["fusion: CPUs"]["asked"], "0");
  EXPECT_FALSE(settings.contains("locked memory"));
}

TEST(DoctorCommand, SaysHowMuchMemoryThreadsAndRingsHoldForImagesOfTheDescribedCamera) {
  const TemporaryFolder folder;
  const std::string json_file = (folder.path() / "doctor.json").string();
  const std::string car = (folder.path() / "a.toml").string();
  std::ofstream(car) << "[vehicle.camera]\nwidth = 1000\nheight = 500\nfx = 700.0\nfy = 700.0\n"
                        "cx = 500.0\ncy = 250.0\nbaseline = 0.5\n";
  const ProcessResult result =
      run({maploop_command(), "doctor", "--realtime", "--json", json_file, "--config", car});
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("images of 500000 pixels"), std::string::npos);
  const json memory = read_json(json_file)["memory"];
  double bytes = 0.0;
  bool ring = false;
  for (const json& part : memory["parts"]) {
    bytes += part["bytes"].get<double>();
    ring = ring || (part["name"] == "camera -> stereo" && part["bytes"] >= 4 * 1'000'000);
  }
  EXPECT_TRUE(ring) << memory;
  EXPECT_NEAR(memory["megabytes"], bytes / 1e6, 0.01);
}

TEST(DoctorCommand, SaysWhatIsRefusedWhyAndWhatToDo) {
  if (!can_drop_capabilities()) GTEST_SKIP() << "setpriv cannot drop capabilities here";
  const json settings = settings_of(without_capabilities({maploop_command(), "doctor"}));
  for (const char* name : {"fusion: scheduling", "locked memory"}) {
    EXPECT_EQ(settings[name]["verdict"], "refused") << settings[name];
    EXPECT_NE(settings[name]["reason"], "");
  }
  EXPECT_EQ(settings["fusion: scheduling"]["granted"], runtime::read_scheduling().policy);
}

using DoctorOnADrive = DriveTest;

TEST_F(DoctorOnADrive, AReplayWithoutPrivilegesSaysSoAndHasTheSameBits) {
  if (!can_drop_capabilities()) GTEST_SKIP() << "setpriv cannot drop capabilities here";
  const auto replay = [this](bool privileged, const char* pace) {
    const Words command{maploop_command(), "replay", drive(),  "--no-lcm",         pace,
                        "--end",           "3",      "--json", file("result.json")};
    const ProcessResult result = run(privileged ? command : without_capabilities(command));
    EXPECT_EQ(result.status, 0) << result.error;
    json read = read_json(file("result.json"));
    read["said"] = result.error;
    return read;
  };
  const json refused = replay(false, "--speed=1");
  // The test's own policy, which the command inherits: "other", or "other nice 19".
  const std::string inherited = runtime::read_scheduling().policy;
  EXPECT_THAT(refused["said"].get<std::string>(),
              HasSubstr("refused   fusion: scheduling: " + inherited + ", not fifo"));
  EXPECT_THAT(refused["degraded"].dump(),
              HasSubstr("fusion: scheduling is " + inherited + ", not fifo 60"));
  const json lockstep = replay(true, "--lockstep");
  EXPECT_EQ(refused["channels"]["NAV_STATE"], lockstep["channels"]["NAV_STATE"]);
  EXPECT_EQ(lockstep["said"], "") << "virtual time asks for nothing";
}

}  // namespace
}  // namespace maploop
