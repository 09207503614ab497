// Tests what maploop-vehicle leaves out. That its replay has maploop's bits is tested with the
// whole drive.
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using namespace testing;

ProcessResult run_in_vehicle(Words words) {
  words.insert(words.begin(), maploop_command() + "-vehicle");
  return run(words);
}

class InVehicle : public CommandTest {
 protected:
  static void expect_refused(const Words& words, const std::string& remedy) {
    const ProcessResult process = run_in_vehicle(words);
    EXPECT_EQ(process.status, 1);
    EXPECT_THAT(process.error, HasSubstr(remedy));
  }
};

TEST_F(InVehicle, HasTheCommandsOfACarAndNoPages) {
  const std::string help = run_in_vehicle({"--help"}).out;
  for (const char* command : {"  live ", "  replay "}) EXPECT_THAT(help, HasSubstr(command));
  for (const char* command : {"  simulate ", "  dashboard ", "  map "}) {
    EXPECT_THAT(help, Not(HasSubstr(command)));
  }
  EXPECT_THAT(run_in_vehicle({"replay", "--help"}).out, Not(HasSubstr("--report")));
}

TEST_F(InVehicle, RefusesRecordingsThatNeedMoreLibraries) {
  expect_refused({"replay", write("drive.pcap", "a capture")}, "does not read captures");
  std::string database = "SQLite format 3";
  database.resize(100);
  expect_refused({"replay", write("drive.db3", database)}, "does not read databases of rosbag2");
}

class InVehicleOnDrive : public DriveTest {};

TEST_F(InVehicleOnDrive, RefusesAMapThatIsNoNetworkFile) {
  const ProcessResult process =
      run_in_vehicle({"replay", drive(), "--no-lcm", "--map", write("town.osm", "<osm/>")});
  EXPECT_EQ(process.status, 1);
  EXPECT_THAT(process.error, HasSubstr("'maploop map build' makes them"));
}

TEST_F(InVehicleOnDrive, TakesLessThan200Megabytes) {
  const std::string written = file("result.json");
  const ProcessResult process =
      run_in_vehicle({"replay", drive(), "--no-lcm", "--speed", "4", "--json", written});
  ASSERT_EQ(process.status, 0) << process.error;
  EXPECT_LT(read_json(written)["replay"]["peak_memory_bytes"].get<double>(), 200e6);
}

}  // namespace
}  // namespace maploop
