// Tests what can be asked of a replay, on the first six seconds of the recorded drive: its results
// have the bits of one replay in lockstep.
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

constexpr const char* end = "6";  // s

// One replay in lockstep, with its log and a snapshot.
struct Lockstep {
  Lockstep() {
    const ProcessResult process = run_maploop(
        {"replay", drive_0013().string(), "--no-lcm", "--lockstep", "--end", end, "--json",
         in("result.json"), "--record", in("run.lcmlog"), "--snapshot", "3:" + in("snapshot")});
    EXPECT_EQ(process.status, 0) << process.error;
    result = read_json(in("result.json"));
  }

  std::string in(const char* name) const { return (folder.path() / name).string(); }
  std::string log() const { return in("run.lcmlog"); }

  TemporaryFolder folder;
  json result;
};

const Lockstep& lockstep() {
  static const Lockstep lockstep;
  return lockstep;
}

class FirstSeconds : public DriveTest {
 protected:
  // Expects that a run of the drive with these options has the bits and the log of lockstep.
  json expect_same(Words options) const {
    options.insert(options.end(), {"--end", end, "--record", file("other.lcmlog")});
    json result = replay(drive(), options);
    EXPECT_EQ(hashes(result), hashes(lockstep().result));
    const ProcessResult same = run_maploop({"log", "diff", lockstep().log(), file("other.lcmlog")});
    EXPECT_EQ(same.status, 0) << same.out;
    EXPECT_THAT(same.out, HasSubstr("NAV_STATE: same, "));
    return result;
  }

  std::string copy_of_log() const {
    std::filesystem::copy_file(lockstep().log(), file("copy.lcmlog"));
    return file("copy.lcmlog");
  }
};

TEST_F(FirstSeconds, StartAndEndChangeNoBitOfWhatLiesBetween) {
  expect_same({"--start", "4"});
  EXPECT_LT(lockstep().result["channels"]["VO"]["count"], 62);
}

TEST_F(FirstSeconds, TooFastASpeedStallsTheClockNotTheResult) {
  const json too_fast = expect_same({"--speed", "1000"});
  EXPECT_GT(too_fast["replay"]["stalls"], 0);
  EXPECT_EQ(too_fast["replay"]["lost"], 0);
}

TEST_F(FirstSeconds, ARealTimeRunTakesTheSameSnapshotWithoutALoss) {
  const json paced = expect_same({"--speed", "1", "--snapshot", "3:" + file("paced.snapshot")});
  EXPECT_EQ(paced["replay"]["lost"], 0);
  EXPECT_EQ(read_file(file("paced.snapshot")), read_file(lockstep().in("snapshot")));
}

TEST_F(FirstSeconds, AnotherSeedIsAnotherDraw) {
  const auto one = hashes(lockstep().result);
  const auto two = hashes(replay(
      drive(), {"--lockstep", "--end", end, "--seed", "2", "--record", file("other.lcmlog")}));
  EXPECT_NE(one.at("GNSS_FIX"), two.at("GNSS_FIX"));
  EXPECT_EQ(one.at("VO"), two.at("VO"));
  const ProcessResult other = run_maploop({"log", "diff", lockstep().log(), file("other.lcmlog")});
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.out, HasSubstr("GNSS_FIX: different"));
}

// Returns the calibration of that name.
json calibrated(const json& result, const std::string& name) {
  for (const json& one : result["calibration"])
    if (one["name"] == name) return one;
  return {};
}

TEST_F(FirstSeconds, WhatWasLearntOfTheCarIsKeptAndUsed) {
  const Words options{"--lockstep", "--end", end, "--state", file("car.state")};
  const json first = replay(drive(), options);
  EXPECT_EQ(hashes(first), hashes(lockstep().result)) << "there was no state yet";
  EXPECT_THAT(read_file(file("car.state")), HasSubstr("\nsigma = "));
  const json second = replay(drive(), options);
  EXPECT_NE(hashes(second).at("NAV_STATE"), hashes(first).at("NAV_STATE"));
  int better = 0;
  for (const json& c : first["calibration"]) {
    if (c["observed"]) better += calibrated(second, c["name"])["sigma"] < c["sigma"] ? 1 : 0;
  }
  EXPECT_GT(better, 0);
  EXPECT_THAT(refusal(drive(), {"--state", file("car.state"), "--config",
                                write("golf.toml", "[vehicle]\nname = \"golf\"\n")}),
              AllOf(HasSubstr("car.state"), HasSubstr("golf")));
}

TEST_F(FirstSeconds, ADamagedStateIsNamedKeptAsideAndNotUsed) {
  const std::string state = write("car.state", "version = 2\ncar = \"\"\nat = ");
  const ProcessResult run = run_maploop(
      {"replay", lockstep().log(), "--no-lcm", "--lockstep", "--end", "1", "--state", state});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.error, AllOf(HasSubstr("car.state:3"), HasSubstr("car.state.damaged")));
  EXPECT_THAT(read_file(state + ".damaged"), HasSubstr("version = 2"));
}

TEST_F(FirstSeconds, ARestartHasItsPositionAtOnceAndNamesAPlaceThatIsWrong) {
  const auto part = [this](const char* name, Words options) {
    options.insert(options.begin(), {"log", "split", lockstep().log(), "-o", file(name)});
    EXPECT_EQ(run_maploop(options).status, 0);
    return file(name);
  };
  const std::string before = part("before.lcmlog", {"--end", "3.05"});
  const std::string rest =
      part("rest.lcmlog", {"--start", "4.05", "--channels", "IMU|GNSS_FIX|ODOMETRY|VO"});
  const std::string car = part("car.lcmlog", {"--channels", "CALIBRATION"});
  const std::string after = file("after.lcmlog"), state = file("car.state");
  ASSERT_EQ(run_maploop({"log", "merge", car, rest, "-o", after}).status, 0);
  replay(before, {"--lockstep", "--state", state});
  const std::string kept = read_file(state);
  EXPECT_THAT(kept, AllOf(HasSubstr("[place]"), HasSubstr("azimuth_sigma = ")));

  const auto first_row = [&](const Words& options) {
    const ProcessResult run = run_maploop([&] {
      Words words{"replay", after, "--no-lcm", "--lockstep", "--end", "0.8", "--csv", file("csv")};
      words.insert(words.end(), options.begin(), options.end());
      return words;
    }());
    std::istringstream rows(run.status == 0 ? read_file(file("csv")) : "\n");
    std::string row;
    std::getline(rows, row);
    std::getline(rows, row);
    return row + run.error;
  };
  EXPECT_THAT(first_row({}), Not(HasSubstr("aided"))) << "no fix comes in this second";
  const std::string warm = first_row({"--state", state});
  EXPECT_THAT(warm, AnyOf(HasSubstr(",aided,"), HasSubstr(",coasting,")));
  EXPECT_THAT(warm, Not(HasSubstr("maploop: ")));
  EXPECT_THAT(run_maploop({"replay", before, "--no-lcm", "--lockstep", "--state", state}).error,
              HasSubstr("from the future"));
}

TEST_F(FirstSeconds, ALogTakesSnapshotsFaultsAndMomentsAsADriveDoes) {
  const std::string log = lockstep().log();
  const json whole = replay(log, {"--lockstep", "--snapshot", "3:" + file("s")});
  const auto expected = hashes(whole["snapshot"]);
  EXPECT_EQ(expected.size(), 10u);
  EXPECT_EQ(hashes(replay(log, {"--lockstep", "--resume", file("s")})), expected);
  const json lost = replay(log, {"--lockstep", "--fault", "lost@imu:2:1"});
  EXPECT_NE(hashes(lost)["NAV_STATE"], hashes(whole)["NAV_STATE"]);
  const json part = replay(log, {"--speed", "2", "--start", "2", "--end", "4"});
  EXPECT_EQ(hashes(part), hashes(replay(log, {"--lockstep", "--end", "4"})));
}

TEST_F(FirstSeconds, CompressedLogsAreReadToo) {
  ASSERT_EQ(run_maploop({"log", "merge", lockstep().log(), "-o", file("a.lcmlog.gz")}).status, 0);
  EXPECT_EQ(hashes(replay(file("a.lcmlog.gz"), {"--lockstep"})), hashes(lockstep().result));
}

TEST_F(FirstSeconds, ALogIsNotReplacedByItsOwnReplay) {
  const std::string log = copy_of_log();
  refusal(log, {"--record", log});
  EXPECT_EQ(std::filesystem::file_size(log), std::filesystem::file_size(lockstep().log()));
}

TEST_F(FirstSeconds, WhatCannotBeReplayedIsRefusedWithItsReason) {
  const std::string log = copy_of_log();
  const auto refused = [](const std::string& recording) {
    return refusal(recording, {"--lockstep"});
  };
  const auto split = [&](const char* channels, const char* name) {
    EXPECT_EQ(run_maploop({"log", "split", log, "--channels", channels, "-o", file(name)}).status,
              0);
    return file(name);
  };
  EXPECT_THAT(refused(split("IMU|VO", "uncalibrated.lcmlog")),
              HasSubstr("contains no calibration"));
  EXPECT_THAT(refused(split("NAV_STATE", "states.lcmlog")), HasSubstr("no messages of sensors"));
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 9);
  EXPECT_THAT(refused(log), AllOf(HasSubstr("damaged"), HasSubstr("log recover")));
  EXPECT_THAT(refused(write("text", "no log")), HasSubstr("text"));
  EXPECT_THAT(refused(file("nowhere")), HasSubstr("nowhere"));
}

TEST_F(FirstSeconds, ASnapshotThatDoesNotFitIsRefusedWithItsReason) {
  std::filesystem::copy_file(lockstep().in("snapshot"), file("a.snapshot"));
  const auto resume = [this](const std::string& name, Words options = {}) {
    options.insert(options.begin(), {"--resume", file(name)});
    return refusal(drive(), options);
  };
  EXPECT_THAT(resume("a.snapshot", {"--seed", "5"}), HasSubstr("gnss.seed = 1"));
  const std::string other = write("other.toml", "[stereo]\nmax_speed = 50.0\n");
  EXPECT_THAT(resume("a.snapshot", {"--config", other}),
              AllOf(HasSubstr("max_speed"), HasSubstr("a.snapshot")));
  std::filesystem::resize_file(file("a.snapshot"), 5000);
  EXPECT_THAT(resume("a.snapshot"), HasSubstr("it is cut"));
  EXPECT_THAT(resume("nowhere"), HasSubstr("nowhere"));
}

}  // namespace
}  // namespace maploop
