// Tests the scans that are made of clouds.
#include "sensors/bag/cloud_scans.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

namespace maploop::sensors {
namespace {

constexpr Time begin = Time(std::chrono::seconds(1'700'000'000));
constexpr Duration longest_turn = std::chrono::milliseconds(250);

// Adds a point 10 m away, `seconds` after the beginning.
void see(TimedCloud& cloud, double azimuth, double seconds) {
  cloud.points.push_back({static_cast<float>(10.0 * std::cos(azimuth)),
                          static_cast<float>(10.0 * std::sin(azimuth)), 0.0F, 0.0F});
  cloud.times.push_back(begin + from_seconds(seconds));
}

// Takes clouds of 0.1 s, and returns all scans.
std::vector<LidarScan> scans_of(int clouds, auto&& fill) {
  CloudScans maker(longest_turn);
  std::vector<LidarScan> scans;
  for (int number = 0; number < clouds; ++number) {
    TimedCloud cloud;
    fill(cloud, 0.1 * number);
    maker.add(cloud);
    for (LidarScan scan; maker.next(scan);) scans.push_back(scan);
  }
  if (maker.end())
    for (LidarScan scan; maker.next(scan);) scans.push_back(scan);
  return scans;
}

// A scanner that begins to the left, and takes 0.1 s a turn.
TEST(CloudScans, AreTurnsFromRearToRearWhereverTheCloudsBegin) {
  const auto scans = scans_of(3, [](TimedCloud& cloud, double from) {
    for (int i = 3599; i >= 0; --i) {  // in an order that is not that of time
      const double share = i / 3600.0;
      see(cloud, std::numbers::pi / 2.0 - 2.0 * std::numbers::pi * share, from + 0.1 * share);
    }
  });
  ASSERT_EQ(scans.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const double turn = static_cast<double>(i);
    EXPECT_NEAR(to_seconds(scans[i].start - begin), 0.1 * turn + 0.075, 1e-4);
    EXPECT_NEAR(to_seconds(scans[i].stamp - begin), 0.1 * turn + 0.125, 1e-4);
    EXPECT_NEAR(to_seconds(scans[i].end - begin), 0.1 * turn + 0.175, 1e-4);
    EXPECT_EQ(scans[i].points.size(), 3600U);
    EXPECT_TRUE(scans[i].times.empty());
  }
}

// Expects that each cloud is a scan, whose points keep their times.
void expect_each_cloud(const std::vector<LidarScan>& scans, int clouds, std::size_t points) {
  ASSERT_EQ(scans.size(), static_cast<std::size_t>(clouds)) << "none is lost before it is known";
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].sequence, i);
    EXPECT_NEAR(to_seconds(scans[i].start - begin), 0.1 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(scans[i].points.size(), points);
    ASSERT_EQ(scans[i].times.size(), points);
    EXPECT_FLOAT_EQ(scans[i].times.front(),
                    static_cast<float>(to_seconds(scans[i].start - scans[i].stamp)));
    EXPECT_LT(scans[i].start, scans[i].stamp);
    EXPECT_LT(scans[i].stamp, scans[i].end);
  }
}

TEST(CloudScans, OfAScannerWithAPatternAheadAreItsClouds) {
  const auto scans = scans_of(20, [](TimedCloud& cloud, double from) {
    for (int i = 0; i < 1000; ++i)
      see(cloud, 0.6 * std::sin(0.7 * i) * std::cos(0.011 * i), from + 0.0001 * i);
  });
  expect_each_cloud(scans, 20, 1000);
}

TEST(CloudScans, OfAScannerThatTurnsTheOtherWayAreItsClouds) {
  const auto scans = scans_of(20, [](TimedCloud& cloud, double from) {
    for (int i = 0; i < 1000; ++i)
      see(cloud, 2.0 * std::numbers::pi * 0.001 * i, from + 0.0001 * i);
  });
  expect_each_cloud(scans, 20, 1000);
}

// A prism turns faster than any scanner.
TEST(CloudScans, OfAPatternThatTurnsHundredTimesASecondAreItsClouds) {
  const auto scans = scans_of(20, [](TimedCloud& cloud, double from) {
    for (int i = 0; i < 1000; ++i)
      see(cloud, -2.0 * std::numbers::pi * 0.01 * i, from + 0.0001 * i);
  });
  expect_each_cloud(scans, 20, 1000);
}

TEST(CloudScans, OfARecordingThatEndsBeforeATurnAreItsClouds) {
  const auto scans = scans_of(1, [](TimedCloud& cloud, double from) {
    for (int i = 0; i < 500; ++i)
      see(cloud, -2.0 * std::numbers::pi * 0.001 * i, from + 0.0001 * i);
  });
  expect_each_cloud(scans, 1, 500);
}

}  // namespace
}  // namespace maploop::sensors
