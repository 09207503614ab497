// These tests cover the preparation from raw points to surface points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "estimators/lidar/local_map.h"
#include "estimators/lidar/scan_preparation.h"
#include "tests/estimators/lidar/drive_scans.h"

namespace maploop::lidar {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::read_scans;

LidarScan empty_scan() {
  LidarScan scan;
  scan.start = from_nanoseconds(1'000'000'000);
  scan.stamp = scan.start + from_seconds(0.05);
  scan.end = scan.start + from_seconds(0.10);
  return scan;
}

bool same_bits(const PreparedScan& a, const PreparedScan& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const SurfacePoint& p, const SurfacePoint& q) {
                      return p.position == q.position && p.normal == q.normal;
                    });
}

TEST(TurnFraction, FollowsTheClockFromTheRearRoundTheLeft) {
  EXPECT_NEAR(turn_fraction(-10.0f, 0.01f), 0.0f, 1e-3f);
  EXPECT_NEAR(turn_fraction(0.0f, 10.0f), 0.25f, 1e-5f);
  EXPECT_NEAR(turn_fraction(10.0f, 0.0f), 0.5f, 1e-5f);
  EXPECT_NEAR(turn_fraction(0.0f, -10.0f), 0.75f, 1e-5f);
  EXPECT_NEAR(turn_fraction(-10.0f, -0.01f), 1.0f, 1e-3f);
}

TEST(TurnFraction, AgreesWithTheArcTangentOfTheLibrary) {
  for (int i = -1799; i < 1800; ++i) {
    const double angle = i * std::numbers::pi / 1800.0;
    const float fraction = turn_fraction(static_cast<float>(30.0 * std::cos(angle)),
                                         static_cast<float>(30.0 * std::sin(angle)));
    EXPECT_NEAR(fraction, 0.5 - 0.5 * angle / std::numbers::pi, 2e-5) << "azimuth " << angle;
  }
}

TEST(Elevation, IsRaisedWithTheRangeKept) {
  const double delta = 0.00357792;
  const Eigen::Vector3f p(8.0f, -6.0f, -1.5f);
  const Eigen::Vector3f q =
      with_elevation(p, static_cast<float>(std::cos(delta)), static_cast<float>(std::sin(delta)));
  EXPECT_NEAR(q.norm(), p.norm(), 1e-5f);
  EXPECT_NEAR(std::atan2(q.z(), q.head<2>().norm()) - std::atan2(p.z(), p.head<2>().norm()), delta,
              1e-6);
  EXPECT_NEAR(q.y() / q.x(), p.y() / p.x(), 1e-6f);
}

TEST(Twist, IsTheMotionItWasMadeOf) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.2, -0.1, 0.97).normalized()).matrix();
  T.translation() << 1.3, -0.2, 0.05;
  EXPECT_TRUE(Twist::of(T, 0.1).over(0.1).isApprox(T, 1e-12));
  const Eigen::Isometry3d half = Twist::of(T, 0.1).over(0.05);
  EXPECT_TRUE((half * half).isApprox(T, 1e-12));
}

TEST(PointTimes, AreTheirOwnOrThoseOfTheirAzimuths) {
  LidarScan scan = empty_scan();
  const Time from = scan.stamp - from_seconds(0.02);
  scan.points = {{0.0f, 5.0f, 0.0f, 0.0f}, {5.0f, 0.0f, 0.0f, 0.0f}};  // to the left, ahead
  const PointTimes of_azimuths(scan, from);
  EXPECT_NEAR(of_azimuths(0), -0.005f, 1e-6f);  // a quarter of a turn of 0.1 s before
  EXPECT_NEAR(of_azimuths(1), 0.02f, 1e-6f);
  scan.times = {0.01f, -0.03f};
  const PointTimes own(scan, from);
  EXPECT_NEAR(own(0), 0.03f, 1e-6f);
  EXPECT_NEAR(own(1), -0.01f, 1e-6f);
}

// A wall seen from a moving vehicle is bent; after deskewing it is flat and at its position at the
// stamp.
TEST(ScanPreparation, WallSeenFromAMovingVehicleIsFlatAndWhereItWas) {
  LidarScan scan = empty_scan();
  const Twist motion{{20.0, 0.0, 0.0}, {0.0, 0.0, 0.5}};
  const Time stamp = scan.stamp + from_seconds(0.017);
  LidarParameters parameters;
  parameters.elevation_correction = 0.0;
  for (int i = 0; i < 20000; ++i) {
    // In the body at `stamp` there is a wall at y = 12; its earlier position when its beam saw it
    // is computed.
    const int row = i / 400;
    const Eigen::Vector3d wall(-20.0 + 40.0 * (i % 400) / 400.0, 12.0, -1.0 + 4.0 * row / 50.0);
    Eigen::Vector3d seen = wall;
    for (int round = 0; round < 20; ++round) {
      const double turn =
          2.0 * turn_fraction(static_cast<float>(seen.x()), static_cast<float>(seen.y())) - 1.0;
      const double t = to_seconds(scan.stamp - stamp) + turn * 0.05;
      seen = motion.over(t).inverse() * wall;
    }
    scan.points.push_back({static_cast<float>(seen.x()), static_cast<float>(seen.y()),
                           static_cast<float>(seen.z()), 0.0f});
  }
  ScanPreparation preparation(Eigen::Isometry3d::Identity(), parameters);
  PreparedScan prepared;
  preparation.prepare(scan, stamp, motion, &prepared);
  ASSERT_GT(prepared.points.size(), 50u);
  EXPECT_EQ(prepared.stamp, stamp);
  for (const SurfacePoint& p : prepared.points) {
    EXPECT_NEAR(p.position.y(), 12.0f, 2e-3f);
    EXPECT_GT(std::abs(p.normal.y()), 0.999f);
  }
  preparation.prepare(scan, stamp, {}, &prepared);
  const auto off = std::max_element(
      prepared.points.begin(), prepared.points.end(), [](const auto& a, const auto& b) {
        return std::abs(a.position.y() - 12.0f) < std::abs(b.position.y() - 12.0f);
      });
  EXPECT_GT(std::abs(off->position.y() - 12.0f), 0.1f) << "the motion was none to speak of";
}

TEST(ScanPreparation, PointsOfTheRecordedDriveInAnyOrderGiveTheSameBits) {
  MAPLOOP_REQUIRE_DRIVE();
  const sensors::KittiDrive drive(drive_0013());
  LidarScan scan = read_scans(drive, 1).front();
  ScanPreparation preparation(drive.calibration().T_body_velo, {});
  const Twist motion{{13.0, 0.0, 0.0}, {0.0, 0.0, 0.1}};
  PreparedScan in_order, shuffled;
  preparation.prepare(scan, scan.stamp, motion, &in_order);
  EXPECT_GT(in_order.points.size(), 3000u);
  std::shuffle(scan.points.begin(), scan.points.end(), std::mt19937(7));
  preparation.prepare(scan, scan.stamp, motion, &shuffled);
  EXPECT_TRUE(same_bits(in_order, shuffled));
  // Each point is repeated, as some drivers deliver them; the means and hence the surface points
  // are equal.
  const std::vector<LidarPoint> once = scan.points;
  scan.points.insert(scan.points.end(), once.begin(), once.end());
  PreparedScan twice;
  preparation.prepare(scan, scan.stamp, motion, &twice);
  EXPECT_NEAR(static_cast<double>(twice.points.size()), static_cast<double>(in_order.points.size()),
              0.15 * static_cast<double>(
                         in_order.points.size()));  // since voxels of 3 to 5 points now pass
}

TEST(ScanPreparation, NormalsOfTheRoadPointUp) {
  MAPLOOP_REQUIRE_DRIVE();
  const sensors::KittiDrive drive(drive_0013());
  const LidarScan scan = read_scans(drive, 1).front();
  ScanPreparation preparation(drive.calibration().T_body_velo, {});
  PreparedScan prepared;
  preparation.prepare(scan, scan.stamp, Twist{{13.0, 0.0, 0.0}, Eigen::Vector3d::Zero()},
                      &prepared);
  int road = 0, upright = 0;
  for (const SurfacePoint& p : prepared.points) {
    if (!p.has_normal()) continue;
    EXPECT_NEAR(p.normal.norm(), 1.0f, 1e-4f);
    const bool below = p.position.z() < -0.7f && p.position.head<2>().norm() < 10.0f &&
                       std::abs(p.position.y()) < 2.0f;
    road += below;
    upright += below && std::abs(p.normal.z()) > 0.97f;
  }
  EXPECT_GT(road, 20);
  EXPECT_GT(upright, road * 8 / 10);
}

// Points of one beam spread least across the beam, whatever it hit: here foliage ahead.
TEST(ScanPreparation, OneBeamGivesNoNormalAndTwoGiveOne) {
  for (const int beams : {1, 2}) {
    LidarScan scan = empty_scan();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> depth(-1.0f, 1.0f);
    for (int i = 0; i < 400; ++i) {
      const float x = 20.0f + depth(random), y = depth(random);
      const float elevation = 0.01f + (i % 2 < beams - 1 ? 0.035f : 0.0f);
      scan.points.push_back({x, y, std::hypot(x, y) * elevation, 0.0f});
    }
    ScanPreparation preparation(Eigen::Isometry3d::Identity(), {});
    PreparedScan prepared;
    preparation.prepare(scan, scan.stamp, {}, &prepared);
    ASSERT_GT(prepared.points.size(), 3u);
    for (const SurfacePoint& p : prepared.points) EXPECT_EQ(p.has_normal(), beams == 2);
    LocalMap map{LidarParameters{}};
    map.insert(prepared, Eigen::Isometry3d::Identity());
    EXPECT_EQ(map.size() > 0, beams == 2) << "only normals are worth comparing with";
  }
}

TEST(ScanPreparation, WhatIsNoPointIsCropped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  LidarScan scan = empty_scan();
  scan.points = {{nan, 5.0f, 0.0f, 0.0f},    {5.0f, infinite, 0.0f, 0.0f},
                 {1e18f, 1e18f, 0.0f, 0.0f}, {0.5f, 0.5f, 0.0f, 0.0f},
                 {0.0f, 0.0f, 0.0f, 0.0f},   {100.0f, 0.0f, 0.0f, 0.0f}};
  ScanPreparation preparation(Eigen::Isometry3d::Identity(), {});
  PreparedScan prepared;
  preparation.prepare(scan, scan.stamp, {}, &prepared);
  EXPECT_TRUE(prepared.points.empty());
  EXPECT_EQ(prepared.cropped, 6);
  preparation.prepare(empty_scan(), scan.stamp, {}, &prepared);
  EXPECT_TRUE(prepared.points.empty());
  EXPECT_EQ(prepared.cropped, 0);
}

TEST(ScanPreparation, HugeScanIsThinnedEvenlyAndWhatItLeavesOutIsCounted) {
  LidarScan scan = empty_scan();
  for (int i = 0; i < 1'000'000; ++i) {
    const double angle = i * 2.0 * std::numbers::pi / 1'000'000;
    scan.points.push_back({static_cast<float>(30.0 * std::cos(angle)),
                           static_cast<float>(30.0 * std::sin(angle)),
                           static_cast<float>(i % 50) * 0.1f, 0.0f});
  }
  ScanPreparation preparation(Eigen::Isometry3d::Identity(), {});
  PreparedScan prepared;
  preparation.prepare(scan, scan.stamp, {}, &prepared);
  EXPECT_GT(prepared.left_out, 600'000);
  EXPECT_GT(prepared.points.size(), 500u);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const SurfacePoint& p : prepared.points) mean += p.position;
  mean /= static_cast<float>(prepared.points.size());
  EXPECT_LT(mean.head<2>().norm(), 1.0f) << "one side of the turn was left out";
}

}  // namespace
}  // namespace maploop::lidar
