// Tests that whatever is done with the recorded drive, its results have the bits of one replay in
// lockstep, and are as accurate as they were.
#include <chrono>
#include <csignal>
#include <thread>
#include <tuple>

#include "tests/support/command_test.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop {
namespace {

using nlohmann::json;
using namespace testing;

// One replay in lockstep, with all of its files.
struct Lockstep {
  Lockstep() {
    // 8.03 s is between an image and its result, which is not yet available then.
    const ProcessResult process =
        run_maploop({"replay", drive_0013().string(), "--no-lcm", "--lockstep", "--json",
                     in("result.json"), "--poses", in("poses.txt"), "--record", in("raw.lcmlog"),
                     "--record-raw", "--snapshot", "8.03:" + in("snapshot")});
    EXPECT_EQ(process.status, 0) << process.error;
    result = read_json(in("result.json"));
  }

  std::string in(const char* name) const { return (folder.path() / name).string(); }

  TemporaryFolder folder;
  json result;
};

const Lockstep& lockstep() {
  static const Lockstep lockstep;
  return lockstep;
}

class WholeDrive : public DriveTest {};

TEST_F(WholeDrive, StaysAsAccurateAsItWas) {
  const json& r = lockstep().result;
  EXPECT_EQ(r["vo"]["frames"], 144);
  EXPECT_EQ(r["fused"]["frames"], 144);
  EXPECT_NEAR(r["vo"]["distance_m"], 172.9, 0.5);
  // The results are 0.916, 0.493, 0.00170, 2.06 m.
  EXPECT_LT(r["vo"]["segment_100m_percent"], 1.0);
  EXPECT_LT(r["vo"]["common_rotation_removed"]["segment_100m_percent"], 0.55);
  EXPECT_LT(r["vo"]["segment_100m_deg_per_m"], 0.0021);
  EXPECT_LT(r["vo"]["end_point_m"], 2.3);
  // The results are 0.653, 0.505, 0.00249, 1.50 m.
  EXPECT_LT(r["lidar"]["segment_100m_percent"], 0.72);
  EXPECT_LT(r["lidar"]["common_rotation_removed"]["segment_100m_percent"], 0.55);
  EXPECT_LT(r["lidar"]["segment_100m_deg_per_m"], 0.003);
  EXPECT_LT(r["lidar"]["end_point_m"], 1.7);
  // The results are 0.708, 0.46, 0.00189, 1.56 m. The cameras look 0.5 to 0.75 degrees aside from
  // where the truth says, and so does the output of the left camera, as odometry does: with one
  // rotation removed, it is better than odometry.
  EXPECT_LT(r["odom"]["segment_100m_percent"], 0.78);
  EXPECT_LT(r["odom"]["common_rotation_removed"]["segment_100m_percent"], 0.5);
  EXPECT_LT(r["odom"]["segment_100m_deg_per_m"], 0.0021);
  EXPECT_LT(r["odom"]["end_point_m"], 1.75);
  // The position in the frame of the map is that of fixes with an error of 1.8 m: 2.31 m.
  EXPECT_LT(r["navigation"]["rmse_m"], 2.5);
  EXPECT_EQ(r["protection"]["horizontal"]["beyond"], 0);
  EXPECT_LT(r["protection"]["horizontal"]["median_m"], 15.0);  // 13.7 m
  // One trigger exposes both images, so that no odometry speed contradicts the filter.
  EXPECT_FALSE(r["refusals"]["fusion"].contains("speed contradicts the prediction"));
  EXPECT_EQ(evaluation::read_kitti_poses(lockstep().in("poses.txt")).size(), 144u);
}

// The real-time run is without the log and the snapshot of the other one, which change no bit.
TEST_F(WholeDrive, RealTimeHasTheBitsOfLockstepAndLosesNothing) {
  const json& expected = lockstep().result;
  EXPECT_EQ(hashes(expected).size(), 10u) << "raw channels go to the log alone";
  const json real_time = replay(drive(), {"--speed", "1"});
  EXPECT_EQ(hashes(real_time), hashes(expected));
  for (const json& result : {expected, real_time}) EXPECT_EQ(result["replay"]["lost"], 0);
  EXPECT_EQ(real_time["channels"]["VO"]["count"], 144);
  EXPECT_EQ(real_time["channels"]["IMU"]["count"], 144);
  EXPECT_EQ(real_time["channels"]["TRUTH"]["count"], 144);
  EXPECT_GT(real_time["channels"]["HEALTH"]["count"], 10);
}

// The snapshot is of 13:11:00, 8.824 s after the first sample; a second of messages is compared.
TEST_F(WholeDrive, ABlackBoxOfAKilledRunGivesItsBits) {
  Process run({maploop_command(), "replay", drive(), "--no-lcm", "--speed", "3", "--black-box",
               file("box"), "--black-box-size", "300"});
  Words extract{"log", "blackbox", file("box"), "-o", file("box.lcmlog")};
  ProcessResult box;
  for (int i = 0; i < 60 && box.out.find("--resume") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    box = run_maploop(extract);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  run.send_signal(SIGKILL);
  run.wait();
  box = run_maploop(extract);
  ASSERT_THAT(box.out, HasSubstr("--resume")) << box.error;
  replay(file("box.lcmlog"),
         {"--lockstep", "--resume", file("box.snapshot"), "--record", file("again.lcmlog")});
  for (const auto& [log, start, end] :
       {std::tuple("box", "8.8242", "9.8"), {"again", "0", "0.9758"}}) {
    const std::string name = file(log);
    const ProcessResult part = run_maploop({"log", "split", name + ".lcmlog", "--start", start,
                                            "--end", end, "-o", name + ".part.lcmlog"});
    EXPECT_EQ(part.status, 0) << part.error;
  }
  const ProcessResult same =
      run_maploop({"log", "diff", file("box.part.lcmlog"), file("again.part.lcmlog"), "--channels",
                   "NAV_STATE|ODOM_STATE|VO|LIDAR_ODOMETRY|ODOMETRY|IMU"});
  EXPECT_EQ(same.status, 0) << same.out << same.error;
  EXPECT_THAT(same.out, HasSubstr("NAV_STATE: same, 98 messages"));
}

// The C library and OpenCV choose functions by what the processor has. It is said to have less
// here.
TEST_F(WholeDrive, AnOlderProcessorGivesTheSameBits) {
  const ProcessResult process =
      run({"env", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-AVX512F",
           "OPENCV_CPU_DISABLE=AVX512-SKX,AVX2,FMA3,AVX,FP16", maploop_command(), "replay", drive(),
           "--no-lcm", "--lockstep", "--json", file("result.json")});
  ASSERT_EQ(process.status, 0) << process.error;
  EXPECT_EQ(hashes(read_json(file("result.json"))), hashes(lockstep().result));
}

// It contains another copy of OpenCV.
TEST_F(WholeDrive, TheProgramOnAVehicleHasTheSameBits) {
  const ProcessResult process = run({maploop_command() + "-vehicle", "replay", drive(), "--no-lcm",
                                     "--lockstep", "--json", file("result.json")});
  ASSERT_EQ(process.status, 0) << process.error;
  EXPECT_EQ(hashes(read_json(file("result.json"))), hashes(lockstep().result));
}

TEST_F(WholeDrive, ALogOfRawSensorsGivesTheHashesOfTheDrive) {
  const json& expected = lockstep().result;
  const std::string raw = lockstep().in("raw.lcmlog");
  const json log = replay(raw, {"--lockstep", "--record", file("derived.lcmlog")});
  EXPECT_EQ(hashes(log), hashes(expected));
  for (const char* sensor : {"camera", "velodyne"}) {
    EXPECT_EQ(log["sensors"][sensor]["delivered"], expected["sensors"][sensor]["delivered"]);
  }
  EXPECT_EQ(log["fused"], expected["fused"]) << "scored alike: calibration and truth came along";
  EXPECT_EQ(log["vo"], expected["vo"]);
  EXPECT_EQ(hashes(replay(raw, {"--speed", "4"})), hashes(expected));

  const json without_images = replay(file("derived.lcmlog"), {"--lockstep"});
  EXPECT_EQ(hashes(without_images), hashes(expected)) << "the recorded odometry is fused";
  EXPECT_EQ(without_images["fused"], expected["fused"]);
  EXPECT_EQ(without_images["sensors"]["odometry"]["delivered"], 144);
  EXPECT_EQ(without_images["replay"]["images"], 144);
}

TEST_F(WholeDrive, AnMcapFileOfRawSensorsGivesTheHashesOfTheDrive) {
  const json& expected = lockstep().result;
  const ProcessResult converted =
      run_maploop({"log", "convert", lockstep().in("raw.lcmlog"), "-o", file("raw.mcap")});
  ASSERT_EQ(converted.status, 0) << converted.error;
  const json mcap = replay(file("raw.mcap"), {"--lockstep", "--record", file("derived.mcap")});
  EXPECT_EQ(hashes(mcap), hashes(expected));
  EXPECT_EQ(mcap["fused"], expected["fused"]) << "scored alike: calibration and truth came along";
  EXPECT_EQ(hashes(replay(file("derived.mcap"), {"--lockstep"})), hashes(expected))
      << "the recorded odometry is fused";
}

TEST_F(WholeDrive, AResumedRunHasTheHashesAndTheLogOfTheWholeRunFromThereOn) {
  const json& snapshot = lockstep().result["snapshot"];
  const auto expected = hashes(snapshot);
  EXPECT_EQ(expected.size(), 10u);
  EXPECT_GT(snapshot["channels"]["VO"]["count"], 60);
  const std::string resume = lockstep().in("snapshot");
  EXPECT_EQ(hashes(replay(drive(),
                          {"--lockstep", "--resume", resume, "--record", file("resumed.lcmlog")})),
            expected);
  EXPECT_EQ(hashes(replay(drive(), {"--speed", "2", "--resume", resume})), expected);

  // The start is later than the snapshot by a microsecond, the resolution of a log's clock.
  const std::string start = std::to_string(snapshot["at_s"].get<double>() + 1e-6);
  const std::string channels = "NAV_STATE|VO|LIDAR_ODOMETRY|ODOMETRY|IMU|GNSS_FIX|TRUTH";
  ASSERT_EQ(run_maploop({"log", "split", lockstep().in("raw.lcmlog"), "--start", start,
                         "--channels", channels, "-o", file("tail.lcmlog")})
                .status,
            0);
  const ProcessResult same = run_maploop(
      {"log", "diff", file("tail.lcmlog"), file("resumed.lcmlog"), "--channels", channels});
  EXPECT_EQ(same.status, 0) << same.out;
  EXPECT_THAT(same.out, HasSubstr("NAV_STATE: same"));
}

}  // namespace
}  // namespace maploop
