// A vehicle that goes on from a snapshot sends what one that drove there sends.
#include "runtime/vehicle/playback/snapshot.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/message_tape.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle::snapshot_test {
namespace {

using maploop::testing::MessageTape;
using maploop::testing::TemporaryFolder;
using runtime::DataClock;
using std::chrono::milliseconds;
using testing::drive_start;
using testing::fake_calibration;
using testing::fake_sensors;

constexpr double seconds = 3.0;

struct Driven {
  std::unique_ptr<MessageTape> tape = std::make_unique<MessageTape>();
  std::vector<Snapshot> snapshots;
  VehicleReport report;
};

Driven drive(const DataClock& clock, const std::vector<Time>& cuts) {
  Driven run;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), clock, {run.tape.get()}, {});
  vehicle.take_snapshots(cuts, [&](const Snapshot& s) { run.snapshots.push_back(s); });
  vehicle.start();
  vehicle.wait();
  run.report = vehicle.report();
  return run;
}

MessageTape::Channels resume(const Snapshot& snapshot, const DataClock& clock) {
  MessageTape tape;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), clock, {&tape}, {});
  vehicle.resume(snapshot);
  vehicle.start();
  vehicle.wait();
  return tape.all();
}

// One image every 103 ms, its result 55 ms later: these cuts lie before, between and after them.
std::vector<Time> cuts_everywhere() {
  std::vector<Time> cuts;
  for (int ms = 20; ms < 2990; ms += 170) cuts.push_back(drive_start + milliseconds(ms));
  return cuts;
}

TEST(Snapshot, AResumedRunSendsWhatTheWholeRunSends) {
  const Driven whole = drive(DataClock::virtual_time(), cuts_everywhere());
  ASSERT_EQ(whole.snapshots.size(), cuts_everywhere().size());
  for (const Snapshot& snapshot : whole.snapshots) {
    const auto expected = whole.tape->after(snapshot.at);
    EXPECT_GE(expected.size(), 3u);
    EXPECT_EQ(resume(snapshot, DataClock::virtual_time()), expected)
        << "from " << format_time(snapshot.at);
  }
}

TEST(Snapshot, TakingThemChangesNoBit) {
  EXPECT_EQ(drive(DataClock::virtual_time(), {}).tape->all(),
            drive(DataClock::virtual_time(), cuts_everywhere()).tape->all());
}

// The odometry of a log without images, from a disk that is slower than all other sensors.
Sensors logged_sensors() {
  Sensors sensors = fake_sensors(seconds);
  sensors.camera.reset();
  sensors.velodyne.reset();
  sensors.odometry = std::make_unique<testing::FakeSource<RelativeMotion>>(
      static_cast<std::uint64_t>(seconds * 10), [](std::uint64_t i, RelativeMotion& motion) {
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
  const auto run = [](const std::vector<Time>& cuts) {
    MessageTape tape;
    Vehicle vehicle({}, fake_calibration(), logged_sensors(), DataClock::virtual_time(), {&tape},
                    {});
    std::size_t taken = 0;
    vehicle.take_snapshots(cuts, [&](const Snapshot&) { ++taken; });
    vehicle.start();
    vehicle.wait();
    EXPECT_EQ(taken, cuts.size());
    return tape.all();
  };
  EXPECT_EQ(run({}), run(cuts_everywhere()));
}

// Stages without input are at the drive's end at once, and hold more cuts than their rings do.
TEST(Snapshot, IsTakenWhereThereAreNoImagesAndNoScans) {
  Sensors sensors = fake_sensors(seconds);
  sensors.camera = std::make_unique<testing::FakeSource<StereoPair>>(0, nullptr);
  sensors.velodyne = std::make_unique<testing::FakeSource<LidarScan>>(0, nullptr);
  std::size_t taken = 0;
  Vehicle vehicle({}, fake_calibration(), std::move(sensors), DataClock::virtual_time(), {}, {});
  vehicle.take_snapshots(cuts_everywhere(), [&](const Snapshot&) { ++taken; });
  vehicle.start();
  vehicle.wait();
  EXPECT_EQ(taken, cuts_everywhere().size());
}

TEST(Snapshot, OneTakenInRealTimeHasTheBitsOfLockstep) {
  const std::vector<Time> cuts{drive_start + milliseconds(500), drive_start + milliseconds(1230)};
  const Driven lockstep = drive(DataClock::virtual_time(), cuts);
  const Driven paced = drive(DataClock::paced(4.0), cuts);
  ASSERT_EQ(paced.snapshots.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(paced.snapshots[i].parts == lockstep.snapshots[i].parts);
  }
  EXPECT_EQ(resume(paced.snapshots[1], DataClock::paced(4.0)),
            lockstep.tape->after(paced.snapshots[1].at));
}

TEST(Snapshot, OfAResumedRunIsTheOneOfTheWholeRun) {
  const Driven whole = drive(DataClock::virtual_time(), cuts_everywhere());
  std::vector<Snapshot> again;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), DataClock::virtual_time(), {}, {});
  vehicle.resume(whole.snapshots[3]);
  vehicle.take_snapshots(cuts_everywhere(), [&](const Snapshot& s) { again.push_back(s); });
  vehicle.start();
  vehicle.wait();
  ASSERT_EQ(again.size(), whole.snapshots.size() - 4) << "those up to its begin are left out";
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_TRUE(again[i].parts == whole.snapshots[i + 4].parts);
  }
}

TEST(Snapshot, MomentsOutsideOfTheDriveAreNeverTaken) {
  const Driven run = drive(DataClock::virtual_time(),
                           {drive_start - milliseconds(10), drive_start + std::chrono::hours(1)});
  EXPECT_TRUE(run.snapshots.empty());
  EXPECT_EQ(run.report.health.degraded,
            drive(DataClock::virtual_time(), {}).report.health.degraded);
}

TEST(Snapshot, AHandlerThatFailsIsNamedAndHoldsNobodyUp) {
  MessageTape tape;
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), DataClock::virtual_time(), {&tape},
                  {});
  vehicle.take_snapshots(cuts_everywhere(),
                         [](const Snapshot&) { throw std::runtime_error("disk full"); });
  vehicle.start();
  vehicle.wait();
  EXPECT_EQ(tape.all(), drive(DataClock::virtual_time(), {}).tape->all());
  std::string said;
  for (const std::string& sentence : vehicle.report().health.degraded) said += sentence;
  EXPECT_NE(said.find("snapshot has ended: disk full"), std::string::npos) << said;
}

TEST(Snapshot, AnotherRecordingIsRefused) {
  const Driven run = drive(DataClock::virtual_time(), {drive_start + milliseconds(500)});
  Snapshot snapshot = run.snapshots.at(0);
  snapshot.first += milliseconds(7);
  Vehicle vehicle({}, fake_calibration(), fake_sensors(seconds), DataClock::virtual_time(), {}, {});
  vehicle.resume(snapshot);
  EXPECT_THROW(vehicle.start(), std::runtime_error);
}

TEST(Snapshot, OtherSettingsOfAnEstimatorAreRefusedByName) {
  const Driven run = drive(DataClock::virtual_time(), {drive_start + milliseconds(500)});
  VehicleConfig config;
  config.fusion.gyro_noise *= 2.0;
  Vehicle vehicle(config, fake_calibration(), fake_sensors(seconds), DataClock::virtual_time(), {},
                  {});
  try {
    vehicle.resume(run.snapshots.at(0));
    FAIL() << "resumed";
  } catch (const ArchiveError& e) {
    EXPECT_NE(std::string(e.what()).find("gyro_noise = 8.7e-05, and here it is 0.000174"),
              std::string::npos)
        << e.what();
  }
}

class SnapshotFile : public ::testing::Test {
 protected:
  std::string refusal(const VehicleConfig& config = {}) const {
    try {
      read_snapshot(file_, config);
      return {};
    } catch (const std::runtime_error& e) {
      return e.what();
    }
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
  EXPECT_NE(refusal(config).find("gnss.seed = 1, and here it is 7"), std::string::npos)
      << refusal(config);
  config = {};
  config.scheduling.fusion = runtime::Scheduling::fifo(1);
  config.lcm_url = "memq://";
  EXPECT_EQ(refusal(config), "") << "where it runs decides nothing";
}

TEST_F(SnapshotFile, WhatIsBrokenOrMissingIsRefusedWithItsName) {
  EXPECT_NE(refusal().find("a.snapshot': the file is missing"), std::string::npos) << refusal();
  write_snapshot(file_, snapshot_, {});
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  EXPECT_NE(refusal().find("a.snapshot': it holds"), std::string::npos) << refusal();
  std::ofstream(file_) << "no snapshot at all, but long enough to hold a header";
  EXPECT_NE(refusal().find("it is no archive"), std::string::npos) << refusal();
}

TEST_F(SnapshotFile, ThatCannotBeWrittenIsNamed) {
  try {
    write_snapshot(folder_.path() / "missing" / "a.snapshot", snapshot_, {});
    FAIL() << "written";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("missing/a.snapshot"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace maploop::vehicle::snapshot_test
