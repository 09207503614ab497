// These tests measure on real data that estimators hold no more memory than their stages declare.
#include "runtime/vehicle/graph/memory_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <string>

#include "estimators/fusion/guarded_filter.h"
#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "mapmatch/nav_matcher.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::held_bytes;

// Returns the most that an estimator has held while it took its inputs.
template <class Make, class Take>
std::size_t held(Make make, Take take) {
  const long before = held_bytes();
  auto estimator = make();
  long most = held_bytes() - before;
  while (take(estimator)) most = std::max(most, held_bytes() - before);
  return static_cast<std::size_t>(std::max(most, 0L)) + sizeof(estimator);
}

// A budget that is far above what is held says nothing.
void expect_near(std::size_t held, std::size_t budget) {
  std::cout << "holds " << held << " of " << budget << " bytes\n";
  EXPECT_LE(held, budget);
  EXPECT_GE(held, budget / 2);
}

class EstimatorOf0013 : public ::testing::Test {
 public:
  void SetUp() override {
    if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
    MAPLOOP_REQUIRE_DRIVE();
    recording = open_recording(maploop::testing::drive_0013(), config);
    sensors = recording.sensors(Time::min());
  }

  VehicleConfig config;
  Recording recording;
  Sensors sensors;
};

TEST_F(EstimatorOf0013, StereoIsWithinItsBudget) {
  StereoPair pair;
  ASSERT_TRUE(sensors.camera->next(pair));
  const std::size_t pixels = pair.left.pixels.size();
  int left = 60;
  expect_near(
      held([&] { return stereo::StereoOdometry(recording.calibration.stereo, config.stereo); },
           [&](auto& odometry) {
             odometry.process(pair);
             return --left > 0 && sensors.camera->next(pair);
           }),
      stages::stereo.memory.bytes(pixels));
}

TEST_F(EstimatorOf0013, LidarIsWithinItsBudget) {
  LidarScan scan;
  ASSERT_TRUE(sensors.velodyne->next(scan));
  expect_near(held(
                  [&] {
                    return lidar::VisualLidarOdometer(recording.calibration.T_body_velo,
                                                      config.lidar);
                  },
                  [&](auto& odometer) {
                    odometer.process(&scan, nullptr);
                    return sensors.velodyne->next(scan);
                  }),
              stages::lidar.memory.bytes(0));
}

TEST_F(EstimatorOf0013, FusionIsWithinItsBudgetWithFeedbackOfTheMap) {
  GnssFix fix;
  ImuSample sample;
  MapFeedback feedback;
  ASSERT_TRUE(sensors.gnss->next(fix));
  expect_near(held(
                  [&] {
                    fusion::GuardedFilter filter(fusion::ReducedImuFilter(config.fusion),
                                                 config.guard);
                    filter.add(fix);
                    return filter;
                  },
                  [&](auto& filter) {
                    filter.add(sample);
                    feedback.stamp = sample.stamp;
                    filter.add(feedback);
                    return sensors.imu->next(sample);
                  }),
              stages::fusion.memory.bytes(0));
}

TEST_F(EstimatorOf0013, MatcherIsWithinItsBudget) {
  MapParameters map;
  map.file = (maploop::testing::real_data() / "maps/karlsruhe_2012-04.osm.pbf").string();
  const auto roads = load_road_map(map);
  expect_near(
      held([&] { return mapmatch::NavMatcher(roads->network, roads->rules, config.mapmatch); },
           [](auto&) { return false; }),
      stages::mapmatch.memory.bytes(0));
}

TEST(MemoryBudget, PppIsWithinItsBudget) {
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  MAPLOOP_REQUIRE_REAL_DATA();
  const Recording recording = open_recording(
      maploop::testing::real_data() / "gnss/riverside_drive/COM3_200712.obs.gz", VehicleConfig{});
  Sensors sensors = recording.sensors(Time::min());
  GnssEpoch epoch;
  expect_near(held([&] { return sensors.ppp->make_map_aided_filter(); },
                   [&](auto& filter) {
                     if (!sensors.epochs->next(epoch)) return false;
                     filter.process(epoch.epoch);
                     return true;
                   }),
              stages::ppp.memory.bytes(0));
}

TEST(MemoryBudget, HasEachThreadAndEachRingWithItsBuffers) {
  const SampleSizes sizes{.pixels = 1000, .points = 100};
  const std::vector<MemoryPart> parts = memory_budget(sizes, {});
  const auto part = [&](const std::string& name) {
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const MemoryPart& p) { return p.name == name; });
    return found != parts.end() ? *found : MemoryPart{};
  };
  EXPECT_EQ(part("camera -> stereo").count, 4u);
  EXPECT_EQ(part("camera -> stereo").each, sizeof(StereoPair) + 2000);
  EXPECT_EQ(part("velodyne -> lidar").each, sizeof(LidarScan) + 100 * 20);
  EXPECT_EQ(part("fusion -> publisher").bytes(), 1024 * sizeof(FusedState));
  EXPECT_EQ(part("velodyne loader").bytes(), 6 * part("velodyne -> lidar").each);
  const std::size_t stack = 256 * 1024;
  EXPECT_EQ(part("stereo").bytes(), stack + stages::stereo.memory.bytes(sizes.pixels));
  EXPECT_EQ(part("lidar").bytes(), stack + stages::lidar.memory.bytes(sizes.pixels));
  EXPECT_GE(part("health").bytes(), 0u);
}

}  // namespace
}  // namespace maploop::vehicle
