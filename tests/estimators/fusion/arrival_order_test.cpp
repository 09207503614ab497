// Late and shuffled measurements must give the same bits as timely ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/recorded_drive.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/real_data.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

// Returns a drive's first seconds in the order of the stamps.
std::vector<Measurement> in_order(const RecordedDrive& drive, double seconds) {
  std::vector<Measurement> all = as_available(drive.imu, drive.odometry, drive.start);
  std::erase_if(all, [&](const Measurement& m) {
    return stamp_of(m) > drive.start.stamp + from_seconds(seconds) ||
           stamp_of(m) < drive.start.stamp - from_seconds(0.5);
  });
  std::stable_sort(all.begin(), all.end(), [](const Measurement& a, const Measurement& b) {
    return stamp_of(a) < stamp_of(b);
  });
  return all;
}

// Returns the measurements, each delayed by its own random time.
std::vector<Measurement> shuffled(const std::vector<Measurement>& ordered, double max_delay,
                                  unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> delay(0.0, max_delay);
  std::vector<std::pair<Time, Measurement>> arrivals;
  for (const Measurement& m : ordered) {
    arrivals.emplace_back(stamp_of(m) + from_seconds(delay(random)), m);
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Measurement> result;
  for (auto& [time, m] : arrivals) result.push_back(m);
  return result;
}

void expect_same_bits(const NavState& a, const NavState& b) {
  EXPECT_EQ(a.position_enu, b.position_enu);
  EXPECT_EQ(a.velocity_enu, b.velocity_enu);
  EXPECT_EQ(a.attitude.azimuth, b.attitude.azimuth);
  EXPECT_EQ(a.attitude.pitch, b.attitude.pitch);
  EXPECT_EQ(a.attitude.roll, b.attitude.roll);
  EXPECT_EQ(a.gyro_bias, b.gyro_bias);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.odometry_applied, b.odometry_applied);
  EXPECT_EQ(a.odometry_refused, b.odometry_refused);
  EXPECT_EQ(a.imu_stamp, b.imu_stamp);
  EXPECT_EQ(a.odometry_stamp, b.odometry_stamp);
}

void expect_order_does_not_matter(const std::vector<Measurement>& ordered, double max_delay) {
  ReducedImuFilter timely({}, test_origin());
  for (const Measurement& m : ordered) add(timely, m);
  ASSERT_TRUE(timely.initialized());
  for (unsigned seed = 0; seed < 10; ++seed) {
    ReducedImuFilter late({}, test_origin());
    for (const Measurement& m : shuffled(ordered, max_delay, seed)) add(late, m);
    ASSERT_EQ(late.status().refused_for(Reason::too_old), 0u);
    for (const double ago : {1.3, 0.55, 0.1, 0.0, -0.1}) {
      const Time t = timely.newest() - from_seconds(ago);
      ASSERT_TRUE(late.state_at(t));
      expect_same_bits(*timely.state_at(t), *late.state_at(t));
    }
  }
}

TEST(ArrivalOrder, DoesNotMatterAtTenHertz) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const RecordedDrive drive =
      load_track_drive(real_data(), "2011_09_30_drive_0020", {0.3, radians(0.1)});
  expect_order_does_not_matter(in_order(drive, 40.0), 0.4);
}

TEST(ArrivalOrder, DoesNotMatterAtAHundredHertz) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const RecordedDrive drive = load_sequence_00(real_data(), {0.3, radians(0.15)});
  expect_order_does_not_matter(in_order(drive, 40.0), 0.4);  // contains a silence of 1.6 s
}

TEST(ArrivalOrder, DoesNotMatterWithLossesFailuresAndTwoSensorsAtOneStamp) {
  MotionProfile profile;
  profile.yaw_rate = [](double t) { return 0.3 * std::sin(t); };
  const SyntheticDrive drive(profile, 30.0, test_origin());
  const SensorNoise noise{.force_sigma = 0.2, .odometry_speed_sigma = 0.3, .seed = 3};
  std::vector<Measurement> all =
      as_available(drive.imu(50.0, noise), drive.odometry(10.0, noise), drive.fix(1.0, 0.06));
  std::mt19937 random(11);
  std::vector<Measurement> kept;
  for (Measurement& m : all) {
    if (auto* motion = std::get_if<RelativeMotion>(&m)) {
      if (random() % 5 == 0) continue;  // lost
      if (random() % 5 == 0) motion->status = OdometryStatus::too_few_inliers;
      if (random() % 10 == 0) motion->translation.x() *= 3.0;  // gated
    }
    auto* sample = std::get_if<ImuSample>(&m);
    if (sample != nullptr) sample->sequence *= 2;
    kept.push_back(m);
    if (sample != nullptr && random() % 10 == 0) {
      ImuSample twin = *sample;
      ++twin.sequence;
      twin.yaw_rate += 0.01;
      kept.push_back(twin);
    }
  }
  std::stable_sort(kept.begin(), kept.end(), [](const Measurement& a, const Measurement& b) {
    return stamp_of(a) < stamp_of(b);
  });
  expect_order_does_not_matter(kept, 0.9);
}

}  // namespace
}  // namespace maploop::fusion
