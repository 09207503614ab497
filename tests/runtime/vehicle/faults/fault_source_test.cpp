// Tests each fault on a short stream, sample by sample.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault_corruption.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using testing::drive_start;
using testing::fake_sensors;

const double focal_length = testing::fake_calibration().stereo.fx;

// Stream contains what the IMU delivers at 100 Hz with the given faults.
struct Stream {
  explicit Stream(const std::vector<std::string>& faults, double seconds = 2.0)
      : injection(parsed(faults), drive_start, focal_length) {
    Sensors sensors = injection.inject(fake_sensors(seconds));
    for (ImuSample s; sensors.imu->next(s);) samples.push_back(s);
    report = sensors.imu->report();
    EXPECT_EQ(report.delivered, samples.size());
    for (std::size_t i = 1; i < samples.size(); ++i) {
      EXPECT_GT(samples[i].available, samples[i - 1].available) << i;
    }
  }

  static std::vector<Fault> parsed(const std::vector<std::string>& texts) {
    std::vector<Fault> faults;
    faults.reserve(texts.size());
    for (const std::string& text : texts) faults.push_back(parse_fault(text));
    return faults;
  }
  std::uint64_t struck() const { return injection.counts().at(0).struck; }
  std::vector<std::uint64_t> sequences() const {
    std::vector<std::uint64_t> all;
    for (const ImuSample& s : samples) all.push_back(s.sequence);
    return all;
  }

  FaultInjection injection;
  std::vector<ImuSample> samples;
  sensors::SourceReport report;
};

TEST(FaultSource, LostSamplesLeaveAGapInTheSequenceAndAreReported) {
  const Stream s({"lost@imu:0.5:0.2"});
  ASSERT_EQ(s.samples.size(), 180u);
  EXPECT_EQ(s.struck(), 20u);
  EXPECT_EQ(s.samples[49].sequence, 49u);
  EXPECT_EQ(s.samples[50].sequence, 70u);
  EXPECT_EQ(s.report.refused, 20u);
  ASSERT_EQ(s.report.refusals.size(), 20u);
  EXPECT_EQ(s.report.refusals[0].file, "lost@imu:0.5:0.2");
}

TEST(FaultSource, EachSeedDrawsItsOwnShareReproducibly) {
  const Stream a({"lost@imu,share=0.3"}, 20.0);
  const Stream b({"lost@imu,share=0.3"}, 20.0);
  const Stream c({"lost@imu,share=0.3,seed=2"}, 20.0);
  EXPECT_EQ(a.sequences(), b.sequences());
  EXPECT_NE(a.sequences(), c.sequences());
  // Of 2000 draws 600 +- 20 (1 sigma) are expected.
  EXPECT_NEAR(static_cast<double>(a.struck()), 600.0, 80.0);
  EXPECT_NEAR(static_cast<double>(c.struck()), 600.0, 80.0);
}

TEST(FaultSource, ALateSampleKeepsItsStampAndHoldsUpWhatFollows) {
  const Stream s({"late@imu:0.5:0.1,by=0.05"});
  ASSERT_EQ(s.samples.size(), 200u);
  EXPECT_EQ(s.struck(), 10u);
  EXPECT_EQ(s.samples[49].available, drive_start + milliseconds(490));
  EXPECT_EQ(s.samples[50].available, drive_start + milliseconds(550));
  EXPECT_EQ(s.samples[50].stamp, drive_start + milliseconds(440));
  EXPECT_EQ(s.samples[59].available, drive_start + milliseconds(640));
  // The samples of 600 to 640 ms follow at once, in their order; then nothing is held up.
  for (std::size_t i = 60; i < 65; ++i) {
    EXPECT_LT(s.samples[i].available, drive_start + milliseconds(641));
  }
  EXPECT_EQ(s.samples[65].available, drive_start + milliseconds(650));
}

TEST(FaultSource, ADuplicateIsTheSameSampleArrivingAgain) {
  const Stream s({"duplicated@imu:0.5:0.05"});
  ASSERT_EQ(s.samples.size(), 205u);
  EXPECT_EQ(s.struck(), 5u);
  EXPECT_EQ(s.samples[50].sequence, 50u);
  EXPECT_EQ(s.samples[51].sequence, 50u);
  EXPECT_EQ(s.samples[51].stamp, s.samples[50].stamp);
  EXPECT_EQ(s.samples[51].available, s.samples[50].available + milliseconds(1));
  EXPECT_EQ(s.samples[52].sequence, 51u);
}

TEST(FaultSource, NeighboursChangePlaces) {
  const Stream s({"reordered@imu:0.5:0.04"});
  ASSERT_EQ(s.samples.size(), 200u);
  EXPECT_EQ(s.struck(), 2u) << "the one that overtook is not struck itself";
  const std::vector<std::uint64_t> all = s.sequences();
  EXPECT_EQ(std::vector<std::uint64_t>(all.begin() + 49, all.begin() + 55),
            (std::vector<std::uint64_t>{49, 51, 50, 53, 52, 54}));
  EXPECT_LT(s.samples[51].stamp, s.samples[50].stamp);
  EXPECT_LE(s.samples[50].stamp, s.samples[50].available) << "nothing arrives before it happened";
}

TEST(FaultSource, TheLastSampleKeepsItsPlace) {
  const Stream s({"reordered@imu:1.99"});
  ASSERT_EQ(s.samples.size(), 200u);
  EXPECT_EQ(s.samples.back().sequence, 199u);
}

TEST(FaultSource, AJumpMovesStampsAndNothingElse) {
  const Stream s({"jump@imu:0.5:0.1,by=-30"});
  EXPECT_EQ(s.struck(), 10u);
  EXPECT_EQ(s.samples[50].stamp, drive_start + milliseconds(440) - std::chrono::seconds(30));
  EXPECT_EQ(s.samples[50].available, drive_start + milliseconds(500));
  EXPECT_EQ(s.samples[60].stamp, drive_start + milliseconds(540));
}

TEST(FaultSource, NanInEveryNumber) {
  const Stream s({"nan@imu:0.5:0.1"});
  EXPECT_TRUE(std::isnan(s.samples[50].specific_force_forward));
  EXPECT_TRUE(std::isnan(s.samples[50].specific_force_left));
  EXPECT_TRUE(std::isnan(s.samples[50].yaw_rate));
  EXPECT_NEAR(s.samples[60].yaw_rate, 0.01, 1e-6);

  FaultInjection injection(Stream::parsed({"nan@gnss", "nan@velodyne"}), drive_start, focal_length);
  Sensors sensors = injection.inject(fake_sensors(2.0));
  GnssFix fix;
  ASSERT_TRUE(sensors.gnss->next(fix));
  EXPECT_TRUE(std::isnan(fix.position.latitude));
  EXPECT_TRUE(fix.velocity_enu.hasNaN());
  EXPECT_TRUE(fix.position_covariance.hasNaN());
  LidarScan scan;
  ASSERT_TRUE(sensors.velodyne->next(scan));
  ASSERT_EQ(scan.points.size(), 100u);
  EXPECT_TRUE(std::isnan(scan.points[99].z));
}

TEST(FaultSource, AFrozenSensorRepeatsTheFirstNumbersWithStampsThatGoOn) {
  const Stream s({"frozen@imu:0.5:0.1"});
  const Stream healthy({});
  EXPECT_EQ(s.struck(), 10u);
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const std::size_t source = i >= 50 && i < 60 ? 50 : i;
    EXPECT_EQ(s.samples[i].yaw_rate, healthy.samples[source].yaw_rate) << i;
    EXPECT_EQ(s.samples[i].stamp, healthy.samples[i].stamp) << i;
  }

  FaultInjection injection(Stream::parsed({"frozen@gnss"}), drive_start, focal_length);
  Sensors sensors = injection.inject(fake_sensors(3.0));
  GnssFix first, later;
  ASSERT_TRUE(sensors.gnss->next(first) && sensors.gnss->next(later));
  EXPECT_EQ(first.position.latitude, later.position.latitude);
  EXPECT_LT(first.stamp, later.stamp);
}

// Makes an epoch of `count` satellites with one code each.
GnssEpoch epoch_of(int count, double code) {
  GnssEpoch made;
  made.stamp = drive_start + milliseconds(count);
  for (int n = 1; n <= count; ++n) {
    made.epoch.satellites.push_back({{ppp::System::gps, static_cast<std::uint8_t>(n)},
                                     static_cast<std::uint32_t>(made.epoch.signals.size()),
                                     1});
    made.epoch.signals.push_back({.band = '1', .attribute = 'C', .code = code});
  }
  return made;
}

TEST(FaultSource, AFrozenReceiverRepeatsItsSatellitesWithTheirSignals) {
  GnssEpoch later = epoch_of(3, 2.1e7);
  const Time stamp = later.stamp;
  repeat(later, epoch_of(1, 2.0e7));
  EXPECT_EQ(later.stamp, stamp);
  ASSERT_EQ(later.epoch.signals.size(), 1u);
  ASSERT_EQ(later.epoch.satellites.size(), 1u);
  EXPECT_EQ(later.epoch.of(later.epoch.satellites[0])[0].code, 2.0e7);
}

TEST(FaultSource, ImagesTurnBlackOrToNoise) {
  FaultInjection injection(Stream::parsed({"black@camera:0:0.15", "garbage@camera:0.15:0.15"}),
                           drive_start, focal_length);
  Sensors sensors = injection.inject(fake_sensors(2.0));
  StereoPair pair;
  ASSERT_TRUE(sensors.camera->next(pair));
  EXPECT_EQ(pair.left.pixels, std::vector<std::uint8_t>(320 * 120, 0));
  EXPECT_EQ(pair.right.pixels, pair.left.pixels);
  ASSERT_TRUE(sensors.camera->next(pair));
  ASSERT_TRUE(sensors.camera->next(pair));
  EXPECT_NE(pair.right.pixels, pair.left.pixels);
  EXPECT_EQ(pair.left.pixels.size(), 320u * 120u);
  for (const FaultCount& count : injection.counts()) EXPECT_GE(count.struck, 1u) << count.fault;
}

TEST(FaultSource, OfSeveralFaultsTheFirstStrikesFirst) {
  const Stream lost_first({"lost@imu:0.5:0.1", "duplicated@imu:0.5:0.1"});
  EXPECT_EQ(lost_first.injection.counts().at(1).struck, 0u);
  const Stream doubled_first({"duplicated@imu:0.5:0.1", "lost@imu:0.5:0.1"});
  EXPECT_EQ(doubled_first.injection.counts().at(1).struck, 20u);
}

TEST(FaultSource, AFaultOutsideOfTheDriveStrikesNothingAndChangesNothing) {
  const Stream s({"nan@imu:100"});
  EXPECT_EQ(s.struck(), 0u);
  EXPECT_EQ(s.sequences(), Stream({}).sequences());
}

TEST(FaultSource, ASensorThatIsNotThereStaysAway) {
  FaultInjection injection(Stream::parsed({"lost@camera"}), drive_start, focal_length);
  EXPECT_EQ(injection.inject({}).camera, nullptr);
}

}  // namespace
}  // namespace maploop::vehicle
