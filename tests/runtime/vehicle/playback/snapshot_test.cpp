// A vehicle that goes on from a snapshot sends what one that drove there sends.
#include "runtime/vehicle/playback/snapshot.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>
#include <utility>
#include <vector>

#include "tests/runtime/vehicle/driven.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle::snapshot_test {
namespace {

using maploop::testing::error_of;
using maploop::testing::TemporaryFolder;
using runtime::DataClock;
using std::chrono::milliseconds;
using testing::drive;
using testing::drive_start;
using testing::Driven;
using testing::fake_calibration;
using testing::fake_sensors;
using ::testing::HasSubstr;

constexpr double seconds = 3.0;

// One image every 103 ms, its result 55 ms later: these cuts lie before, between and after them.
std::vector<Time> cuts_everywhere() {
  std::vector<Time> cuts;
  for (int ms = 20; ms < 2990; ms += 170) cuts.push_back(drive_start + milliseconds(ms));
  return cuts;
}

Driven drive_with(std::vector<Time> cuts, Sensors sensors = fake_sensors(seconds)) {
  return drive({.sensors = std::move(sensors), .cuts = std::move(cuts)});
}

TEST(Snapshot, AResumedRunSendsWhatTheWholeRunSends) {
  const Driven whole = drive_with(cuts_everywhere());
  EXPECT_EQ(whole.messages, drive_with({}).messages) << "taking them changes no bit";
  ASSERT_EQ(whole.snapshots.size(), cuts_everywhere().size());
  testing::expect_resumes(whole, [](const Snapshot* from) {
    Driven rest = drive({.sensors = fake_sensors(seconds), .from = from});
    EXPECT_GE(rest.messages.size(), 3u);
    return rest;
  });

  const Driven again = drive(
      {.sensors = fake_sensors(seconds), .cuts = cuts_everywhere(), .from = &whole.snapshots[3]});
  ASSERT_EQ(again.snapshots.size(), whole.snapshots.size() - 4)
      << "those up to its begin are left out";
  for (std::size_t i = 0; i < again.snapshots.size(); ++i) {
    EXPECT_TRUE(again.snapshots[i].parts == whole.snapshots[i + 4].parts);
  }
}

// The odometry of a log without images, from a disk that is slower than all other sensors.
Sensors logged_sensors() {
  Sensors sensors = fake_sensors(seconds);
  sensors.camera.reset();
  sensors.velodyne.reset();
  sensors.odometry = testing::fake_source<RelativeMotion>(
      seconds * 10, [](std::uint64_t i, RelativeMotion& motion) {
        std::this_thread::sleep_for(milliseconds(2));
        motion.stamp = drive_start + i * milliseconds(100);
        motion.from = motion.stamp - milliseconds(100);
        motion.available = motion.stamp + milliseconds(55);
        motion.status = OdometryStatus::ok;
        motion.translation = {1.0, 0.0, 0.0};
        motion.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
      });
  return sensors;
}

TEST(Snapshot, TakingThemChangesNoBitOfALogWithoutImages) {
  const Driven saved = drive_with(cuts_everywhere(), logged_sensors());
  EXPECT_EQ(saved.snapshots.size(), cuts_everywhere().size());
  EXPECT_EQ(saved.messages, drive_with({}, logged_sensors()).messages);
}

// Stages without input are at the drive's end at once, and hold more cuts than their rings do.
TEST(Snapshot, IsTakenWhereThereAreNoImagesAndNoScans) {
  Sensors sensors = fake_sensors(seconds);
  sensors.camera = testing::fake_source<StereoPair>(0, [](std::uint64_t, StereoPair&) {});
  sensors.velodyne = testing::fake_source<LidarScan>(0, [](std::uint64_t, LidarScan&) {});
  EXPECT_EQ(drive_with(cuts_everywhere(), std::move(sensors)).snapshots.size(),
            cuts_everywhere().size());
}

TEST(Snapshot, OneTakenInRealTimeHasTheBitsOfLockstep) {
  const std::vector<Time> cuts{drive_start + milliseconds(500), drive_start + milliseconds(1230)};
  const Driven lockstep = drive_with(cuts);
  const Driven paced = drive({.sensors = fake_sensors(seconds), .speed = 4.0, .cuts = cuts});
  ASSERT_EQ(paced.snapshots.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(paced.snapshots[i].parts == lockstep.snapshots[i].parts);
  }
  const Driven resumed =
      drive({.sensors = fake_sensors(seconds), .speed = 4.0, .from = &paced.snapshots[1]});
  EXPECT_EQ(resumed.messages, maploop::testing::after(lockstep.messages, paced.snapshots[1].at));
}

TEST(Snapshot, MomentsOutsideOfTheDriveAreNeverTaken) {
  const Driven run =
      drive_with({drive_start - milliseconds(10), drive_start + std::chrono::hours(1)});
  EXPECT_TRUE(run.snapshots.empty());
  EXPECT_EQ(run.report.health.degraded, drive_with({}).report.health.degraded);
}

TEST(Snapshot, AHandlerThatFailsIsNamedAndHoldsNobodyUp) {
  maploop::testing::MessageTape tape;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), DataClock::virtual_time(), {&tape},
                  {});
  vehicle.take_snapshots(cuts_everywhere(),
                         [](const Snapshot&) { throw std::runtime_error("disk full"); });
  vehicle.start();
  vehicle.wait();
  EXPECT_EQ(tape.all(), drive_with({}).messages);
  EXPECT_THAT(vehicle.report().health.degraded,
              ::testing::Contains(HasSubstr("snapshot has ended: disk full")));
}

TEST(Snapshot, OfAnotherRecordingOrOfAnotherConfigurationIsRefusedByName) {
  const Driven run = drive_with({drive_start + milliseconds(500)}, fake_sensors(1.0));
  Snapshot other = run.snapshots.at(0);
  other.first += milliseconds(7);
  EXPECT_THROW(drive({.sensors = fake_sensors(1.0), .from = &other}), std::runtime_error);
  VehicleConfig config;
  config.fusion.gyro_noise *= 2.0;
  EXPECT_THAT(error_of<ArchiveError>([&] {
                drive({.sensors = fake_sensors(1.0), .config = config, .from = &run.snapshots[0]});
              }),
              HasSubstr("gyro_noise = 8.7e-05, and here it is 0.000174"));
}

class SnapshotFile : public ::testing::Test {
 protected:
  std::string refusal(const VehicleConfig& config = {}) const {
    return error_of([&] { read_snapshot(file_, config); });
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.snapshot";
  Snapshot snapshot_{drive_start + milliseconds(500),
                     drive_start,
                     {{"stereo", {1, 2, 3}}, {"lidar", {6}}, {"fusion", {4, 5}}}};
};

TEST_F(SnapshotFile, ComesBackAsItWas) {
  write_snapshot(file_, snapshot_, {});
  const Snapshot read = read_snapshot(file_, {});
  EXPECT_EQ(read.at, snapshot_.at);
  EXPECT_EQ(read.first, snapshot_.first);
  ASSERT_EQ(read.parts.size(), snapshot_.parts.size());
  EXPECT_TRUE(read.parts == snapshot_.parts);
  EXPECT_EQ(read.part("ppp"), nullptr);
}

TEST_F(SnapshotFile, OtherSettingsOfTheSensorsAreRefusedByName) {
  write_snapshot(file_, snapshot_, {});
  VehicleConfig config;
  config.gnss.seed = 7;
  EXPECT_THAT(refusal(config), HasSubstr("gnss.seed = 1, and here it is 7"));
  config = {};
  config.scheduling.fusion = runtime::Scheduling::fifo(1);
  config.lcm_url = "memq://";
  EXPECT_EQ(refusal(config), "") << "where it runs decides nothing";
}

TEST_F(SnapshotFile, WhatIsBrokenOrMissingIsRefusedWithItsName) {
  EXPECT_THAT(refusal(), HasSubstr("a.snapshot': the file is missing"));
  write_snapshot(file_, snapshot_, {});
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  EXPECT_THAT(refusal(), HasSubstr("a.snapshot': it holds"));
  std::ofstream(file_) << "no snapshot at all, but long enough to hold a header";
  EXPECT_THAT(refusal(), HasSubstr("it is no archive"));
}

TEST_F(SnapshotFile, ThatCannotBeWrittenIsNamed) {
  EXPECT_THAT(
      error_of([&] { write_snapshot(folder_.path() / "missing" / "a.snapshot", snapshot_, {}); }),
      HasSubstr("missing/a.snapshot"));
}

}  // namespace
}  // namespace maploop::vehicle::snapshot_test
