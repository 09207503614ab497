// Tests the faults that change what a sensor measures: each on made-up samples.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "tests/runtime/vehicle/fake_sensors.h"
#include "tests/support/error_of.h"

namespace maploop::vehicle {
namespace {

using testing::drive_start;
using testing::fake_source;

constexpr double made_up_focal_length = 200.0;  // px

// Returns the samples that a sensor delivers with these faults; take(sensors) gives its source.
template <class T, class Take>
std::vector<T> with_faults(const std::vector<std::string>& texts, Sensors sensors, Take take) {
  std::vector<Fault> faults;
  faults.reserve(texts.size());
  for (const std::string& text : texts) faults.push_back(parse_fault(text));
  FaultInjection injection(std::move(faults), drive_start, made_up_focal_length);
  sensors = injection.inject(std::move(sensors));
  std::vector<T> samples;
  for (T sample; take(sensors)->next(sample);) samples.push_back(sample);
  for (const FaultCount& fault : injection.counts()) EXPECT_GT(fault.struck, 0u) << fault.fault;
  return samples;
}

std::vector<ImuSample> inertial(const std::vector<std::string>& faults, bool six = false) {
  Sensors sensors;
  sensors.imu = fake_source<ImuSample>(300, [six](std::uint64_t i, ImuSample& s) {
    s.stamp = s.available = drive_start + i * milliseconds(10);
    s.values() = {1.0, 2.0, 0.1, six, six ? 9.8 : 0.0, six ? 0.01 : 0.0, six ? 0.02 : 0.0};
  });
  return with_faults<ImuSample>(faults, std::move(sensors), [](Sensors& s) { return s.imu.get(); });
}

std::vector<GnssFix> fixes(const std::vector<std::string>& faults) {
  return with_faults<GnssFix>(faults, testing::fake_sensors(8.0),
                              [](Sensors& s) { return s.gnss.get(); });
}

// How far a fix lies from where the receiver is, east north up.
Eigen::Vector3d moved(const GnssFix& fix) {
  return LocalFrame({radians(49.0), radians(8.4), 110.0}).to_enu(fix.position);
}

// A scan of these points, each of which has its index as its time.
LidarScan timed_scan(const std::string& fault, const std::vector<LidarPoint>& points) {
  Sensors sensors;
  sensors.velodyne = fake_source<LidarScan>(1, [&](std::uint64_t, LidarScan& scan) {
    scan.stamp = scan.available = drive_start;
    scan.points = points;
    scan.times.resize(points.size());
    std::iota(scan.times.begin(), scan.times.end(), 0.0F);
  });
  return with_faults<LidarScan>({fault}, std::move(sensors),
                                [](Sensors& s) { return s.velodyne.get(); })
      .at(0);
}

std::vector<LidarPoint> scanned(const std::string& fault, const std::vector<LidarPoint>& points) {
  return timed_scan(fault, points).points;
}

// One pair whose images hold this grey value at each (column, row).
template <class Grey>
StereoPair seen(const std::string& fault, Grey grey) {
  Sensors sensors;
  sensors.camera = fake_source<StereoPair>(1, [&](std::uint64_t, StereoPair& pair) {
    pair.stamp = pair.available = drive_start;
    for (GreyImage* image : {&pair.left, &pair.right}) {
      image->resize(41, 21);
      for (int v = 0; v < 21; ++v) {
        for (int u = 0; u < 41; ++u) {
          image->pixels[std::size_t{41} * static_cast<std::size_t>(v) +
                        static_cast<std::size_t>(u)] = static_cast<std::uint8_t>(grey(u, v));
        }
      }
    }
  });
  return with_faults<StereoPair>({fault}, std::move(sensors),
                                 [](Sensors& s) { return s.camera.get(); })
      .at(0);
}

int at(const GreyImage& image, int u, int v) {
  return image.pixels[static_cast<std::size_t>(image.width) * static_cast<std::size_t>(v) +
                      static_cast<std::size_t>(u)];
}

double norm(const LidarPoint& p) {
  return std::hypot(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

TEST(InertialFault, ABiasIsOnEveryAxisOfItsTargetOnly) {
  const ImuSample gyro = inertial({"bias@gyro,by=2"}, true).front();
  EXPECT_DOUBLE_EQ(gyro.yaw_rate, 0.1 + radians(2.0));
  EXPECT_DOUBLE_EQ(gyro.roll_rate, 0.01 + radians(2.0));
  EXPECT_EQ(gyro.specific_force_forward, 1.0);
  const ImuSample force = inertial({"bias@accelerometer,by=-0.5"}).front();
  EXPECT_EQ(force.specific_force_left, 1.5);
  EXPECT_EQ(force.specific_force_up, 0.0) << "a reduced unit has no such axis";
  EXPECT_EQ(force.yaw_rate, 0.1);
}

TEST(InertialFault, ADriftGrowsFromTheFirstSampleThatIsStruck) {
  const auto samples = inertial({"drift@gyro:1,by=0.5"});
  EXPECT_EQ(samples[99].yaw_rate, 0.1);
  EXPECT_EQ(samples[100].yaw_rate, 0.1);
  EXPECT_NEAR(samples[300 - 1].yaw_rate, 0.1 + radians(0.5) * 1.99, 1e-12);
}

TEST(InertialFault, AScaleMultiplies) {
  EXPECT_DOUBLE_EQ(inertial({"scale@gyro,by=0.1"})[5].yaw_rate, 0.11);
  EXPECT_DOUBLE_EQ(inertial({"scale@accelerometer,by=-0.5"})[5].specific_force_left, 1.0);
}

TEST(InertialFault, NoiseHasItsStandardDeviationAndDependsOnTheSeedAlone) {
  const auto samples = inertial({"noise@accelerometer,by=0.3"});
  double square = 0.0;
  for (const ImuSample& s : samples)
    square += std::pow(s.specific_force_forward - 1.0, 2) / static_cast<double>(samples.size());
  EXPECT_NEAR(std::sqrt(square), 0.3, 0.04) << "of 300 samples";
  EXPECT_EQ(samples[7].values(), inertial({"noise@accelerometer,by=0.3"})[7].values());
  EXPECT_NE(samples[7].values(), inertial({"noise@accelerometer,by=0.3,seed=2"})[7].values());
}

TEST(GnssFault, ABiasAndADriftMoveThePositionEastAndLeaveTheVelocity) {
  EXPECT_LT((moved(fixes({"bias@gnss,by=7"})[3]) - Eigen::Vector3d(7, 0, 0)).norm(), 1e-4);
  const GnssFix drifted = fixes({"drift@gnss:2,by=0.5"})[6];
  EXPECT_LT((moved(drifted) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-4) << "4 s after the start";
  EXPECT_EQ(drifted.velocity_enu, Eigen::Vector3d(0, 10, 0));
}

TEST(GnssFault, ASpoofedReceiverIsPulledAwayWithVelocitiesThatAgree) {
  const auto spoofed = fixes({"spoofed@gnss:2"});
  EXPECT_LT(moved(spoofed[2]).norm(), 1e-6) << "it begins where the vehicle is";
  EXPECT_LT((moved(spoofed[6]) - Eigen::Vector3d(2, 0, 0)).norm(), 1e-4);
  EXPECT_EQ(spoofed[6].velocity_enu, Eigen::Vector3d(0.5, 10, 0));
  EXPECT_EQ(spoofed[1].velocity_enu, Eigen::Vector3d(0, 10, 0));
}

TEST(GnssFault, ObservationsHaveNoPositionToStrike) {
  FaultInjection injection({parse_fault("spoofed@gnss")}, drive_start, made_up_focal_length);
  Sensors sensors;
  sensors.epochs = fake_source<GnssEpoch>(1, [](std::uint64_t, GnssEpoch&) {});
  EXPECT_NE(maploop::testing::error_of<std::invalid_argument>([&] {
              injection.inject(std::move(sensors));
            }).find("ppp.observations=false"),
            std::string::npos);
}

TEST(ClockFault, ASkewedClockRunsAway) {
  const auto samples = inertial({"skewed@imu:1,by=1000"});
  EXPECT_EQ(samples[100].stamp, samples[100].available);
  EXPECT_EQ(samples[299].stamp - samples[299].available, std::chrono::microseconds(1990));
}

TEST(WheelFault, AWornTyreReadsTooMuch) {
  Sensors sensors;
  sensors.wheel = fake_source<WheelSpeed>(3, [](std::uint64_t i, WheelSpeed& s) {
    s.stamp = s.available = drive_start + i * milliseconds(10);
    s.speed = 20.0;
  });
  EXPECT_DOUBLE_EQ(with_faults<WheelSpeed>({"scale@wheel"}, std::move(sensors),
                                           [](Sensors& s) { return s.wheel.get(); })[1]
                       .speed,
                   21.0);
}

TEST(ScanFault, NoiseChangesRangesAndNoDirection) {
  const auto points = scanned("noise@velodyne,by=0.5", {{10, 0, 0, 1}, {0, 20, 0, 1}});
  EXPECT_NE(points[0].x, 10.0F);
  EXPECT_NEAR(points[0].x, 10.0F, 2.5F);
  EXPECT_EQ(points[0].y, 0.0F);
  EXPECT_EQ(points[1].x, 0.0F);
}

TEST(ScanFault, ABumpToTheLeftTurnsThePointsToTheRight) {
  const auto points = scanned("bumped@velodyne,by=30", {{10, 0, 2, 1}});
  EXPECT_NEAR(points[0].x, 10 * std::cos(radians(30.0)), 1e-5);
  EXPECT_NEAR(points[0].y, -5.0, 1e-5);
  EXPECT_EQ(points[0].z, 2.0F);
}

TEST(ScanFault, ABlockedSectorAheadHasNoPoints) {
  const auto points = scanned("blocked@velodyne,by=90",
                              {{10, 0, 0, 1}, {10, 9, 0, 1}, {10, 11, 0, 1}, {-10, 0, 0, 1}});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].y, 11.0F);
}

TEST(ScanFault, ThePointsThatAreLeftKeepTheirTimes) {
  const LidarScan scan = timed_scan("blocked@velodyne,by=90", {{10, 0, 0, 1}, {10, 11, 0, 1}});
  EXPECT_EQ(scan.times, std::vector<float>({1.0F}));
}

TEST(ScanFault, AFrozenScanHasTheTimesOfThePointsThatItRepeats) {
  Sensors sensors;
  sensors.velodyne = fake_source<LidarScan>(2, [](std::uint64_t i, LidarScan& scan) {
    scan.stamp = scan.available = drive_start + i * milliseconds(100);
    scan.points.assign(i + 1, {10, 0, 0, 1});
    scan.times.assign(i + 1, static_cast<float>(i));
  });
  const auto scans = with_faults<LidarScan>({"frozen@velodyne"}, std::move(sensors),
                                            [](Sensors& s) { return s.velodyne.get(); });
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[1].points.size(), 1u);
  EXPECT_EQ(scans[1].times, scans[0].times);
}

TEST(ScanFault, RainMakesShortReturnsAndLosesFarOnes) {
  std::vector<LidarPoint> near(1000, {10, 0, 0, 1}), far(1000, {0, 50, 0, 1});
  const auto close = scanned("rain@velodyne", near);
  EXPECT_EQ(close.size(), 1000u) << "within 20 m nothing is lost";
  std::size_t drops = 0;
  for (const LidarPoint& p : close) drops += norm(p) <= 6.0;
  EXPECT_NEAR(static_cast<double>(drops), 300.0, 60.0);
  const auto distant = scanned("rain@velodyne", far);
  EXPECT_NEAR(static_cast<double>(distant.size()), 1000.0 * (0.3 + 0.7 * 0.7), 60.0);
}

TEST(ImageFault, BlurSpreadsALineOverTheWidthOfItsSquare) {
  const StereoPair pair = seen("blurred@camera,by=2", [](int u, int) { return u == 20 ? 250 : 0; });
  EXPECT_EQ(at(pair.left, 20, 10), 50);
  EXPECT_EQ(at(pair.left, 22, 10), 50);
  EXPECT_EQ(at(pair.left, 23, 10), 0);
  EXPECT_EQ(pair.right.pixels, pair.left.pixels);
}

TEST(ImageFault, ADimmedImageKeepsTheRestOfTheLight) {
  EXPECT_EQ(at(seen("dimmed@camera", [](int, int) { return 205; }).left, 3, 3), 20);
}

TEST(ImageFault, ABumpToTheLeftMovesTheImageToTheRight) {
  const StereoPair pair =
      seen("bumped@camera,by=1.432096", [](int u, int) { return u == 20 ? 250 : 0; });
  EXPECT_GT(at(pair.left, 25, 10), 240) << "5 px at a focal length of 200 px";
  EXPECT_EQ(at(pair.left, 20, 10), 0);
  EXPECT_EQ(at(pair.left, 0, 10), 0) << "was not seen before";
}

TEST(ImageFault, AFrozenCameraShowsTheFirstImageForever) {
  Sensors sensors;
  sensors.camera = fake_source<StereoPair>(3, [](std::uint64_t i, StereoPair& pair) {
    pair.stamp = pair.available = drive_start + i * milliseconds(100);
    for (GreyImage* image : {&pair.left, &pair.right}) {
      image->resize(1, 1);
      image->pixels[0] = static_cast<std::uint8_t>(i);
    }
  });
  const auto pairs = with_faults<StereoPair>({"frozen@camera:0.1"}, std::move(sensors),
                                             [](Sensors& s) { return s.camera.get(); });
  EXPECT_EQ(pairs[2].left.pixels[0], 1);
  EXPECT_GT(pairs[2].stamp, pairs[1].stamp);
}

}  // namespace
}  // namespace maploop::vehicle
