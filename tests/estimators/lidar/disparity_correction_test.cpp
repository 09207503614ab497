// These tests cover the length of visual motions learnt from LiDAR motions; drive_test.cpp tests it
// on the recorded drive.
#include <gtest/gtest.h>

#include <limits>

#include "estimators/lidar/visual_lidar_odometer.h"
#include "msgs/archive.h"

namespace maploop::lidar {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double by_offset = -0.04;  // m / px, for a motion of 1.2 m
constexpr double true_offset = 0.4;  // px

Time at(int pair) {
  return Time(std::chrono::milliseconds(100 * pair));
}

// Returns a motion of 1.2 m, seen with disparities that lack 0.4 px, of which `added` px were
// already added.
VisualMotion visual(int pair, double added) {
  VisualMotion motion;
  motion.status = OdometryStatus::ok;
  motion.from = at(pair - 1);
  motion.stamp = at(pair);
  motion.translation.x() = 1.2 + by_offset * (added - true_offset);
  motion.by_offset[0] = by_offset;
  motion.offset = added;
  motion.offset_sigma = 0.3;
  motion.covariance = 1e-4 * Matrix6::Identity();
  motion.covariance += 0.09 * motion.by_offset * motion.by_offset.transpose();
  return motion;
}

LidarMotion lidar(int pair) {
  LidarMotion motion;
  motion.status = OdometryStatus::ok;
  motion.from = at(pair - 1);
  motion.stamp = at(pair);
  motion.translation.x() = 1.2;
  motion.covariance = 1e-6 * Matrix6::Identity();
  return motion;
}

DisparityCorrection taught(int pairs) {
  DisparityCorrection correction(LidarParameters{});
  for (int k = 1; k <= pairs; ++k) correction.learn(visual(k, 0.1), lidar(k));
  return correction;
}

TEST(DisparityCorrection, GivesVisualMotionsTheLengthOfTheLidars) {
  const DisparityCorrection correction = taught(200);
  EXPECT_NEAR(correction.offset(), true_offset, 0.001);
  EXPECT_LT(correction.sigma(), 0.1);
  // This holds even if the pairs' own estimate of the offset has changed.
  for (const double added : {0.1, 0.35}) {
    const VisualMotion seen = visual(201, added);
    const RelativeMotion corrected = correction.correct(seen);
    EXPECT_NEAR(corrected.translation.x(), 1.2, 0.001);
    EXPECT_LT(corrected.covariance(0, 0), seen.covariance(0, 0));
    EXPECT_GT(corrected.covariance(0, 0), 1e-4);
  }
}

TEST(DisparityCorrection, TheFirstMotionsHardlyMoveIt) {
  const DisparityCorrection correction = taught(1);
  EXPECT_EQ(correction.motions(), 1);
  EXPECT_GT(correction.offset(), 0.1);
  EXPECT_LT(correction.offset(), 0.4);
  EXPECT_LE(correction.sigma(), 0.3);
  EXPECT_GT(correction.sigma(), 0.15);
}

TEST(DisparityCorrection, OneWildMotionMovesItByThreeStandardDeviationsAtMost) {
  DisparityCorrection correction = taught(200);
  LidarMotion wild = lidar(201);
  wild.translation.x() = 2.4;
  const double before = correction.offset();
  correction.learn(visual(201, 0.1), wild);
  EXPECT_NEAR(correction.offset(), before, 0.2);
}

TEST(DisparityCorrection, WhatCannotTeachDoesNot) {
  DisparityCorrection correction(LidarParameters{});
  const auto taught_by = [&](VisualMotion v, LidarMotion l) {
    correction.learn(v, l);
    return correction.motions();
  };
  VisualMotion v = visual(1, 0.1);
  LidarMotion l = lidar(1);
  v.status = OdometryStatus::too_few_inliers;
  EXPECT_EQ(taught_by(v, l), 0);
  v = visual(1, 0.1);
  l.status = OdometryStatus::disagreement;
  EXPECT_EQ(taught_by(v, l), 0);
  l = lidar(1);
  l.degenerate = 1;  // along is not determined: the visual motion's own component
  EXPECT_EQ(taught_by(v, l), 0);
  EXPECT_EQ(taught_by(v, lidar(2)), 0);
  v.by_offset.setZero();  // standing, or a method without this derivative
  EXPECT_EQ(taught_by(v, lidar(1)), 0);
  v = visual(1, 0.1);
  l = lidar(1);
  l.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(taught_by(v, l), 0);
  EXPECT_EQ(correction.correct(v).translation, v.translation);
}

TEST(DisparityCorrection, RefusedMotionsStayAsTheyAre) {
  VisualMotion refused = visual(201, 0.1);
  refused.status = OdometryStatus::too_few_features;
  EXPECT_EQ(taught(200).correct(refused).translation, refused.translation);
  LidarParameters parameters;
  parameters.correct_disparities = false;
  DisparityCorrection off(parameters);
  off.learn(visual(1, 0.1), lidar(1));
  EXPECT_EQ(off.correct(visual(2, 0.1)).translation, visual(2, 0.1).translation);
}

TEST(DisparityCorrection, GoesOnFromAnArchiveWithTheSameBits) {
  DisparityCorrection first = taught(20);
  ArchiveWriter writer;
  writer(first);
  DisparityCorrection second(LidarParameters{});
  ArchiveReader reader(writer.content());
  reader(second);
  reader.finish();
  first.learn(visual(21, 0.1), lidar(21));
  second.learn(visual(21, 0.1), lidar(21));
  EXPECT_EQ(first.offset(), second.offset());
  EXPECT_EQ(first.sigma(), second.sigma());
}

// If a scan is missing or empty, fusion gets the corrected visual motion.
TEST(DisparityCorrection, VisualMotionsThatStandAloneAreCorrected) {
  for (const bool with_scan : {false, true}) {
    VisualLidarOdometer odometer(LidarOdometry(Eigen::Isometry3d::Identity(), {}), taught(200));
    const VisualMotion seen = visual(201, 0.1);
    LidarScan empty;
    empty.start = seen.stamp - std::chrono::milliseconds(50);
    empty.stamp = seen.stamp;
    empty.end = seen.stamp + std::chrono::milliseconds(50);
    const OdometerResult result = odometer.process(with_scan ? &empty : nullptr, &seen);
    EXPECT_NE(result.lidar.status, OdometryStatus::ok);
    EXPECT_EQ(result.odometry.status, OdometryStatus::ok);
    EXPECT_EQ(result.odometry.stamp, seen.stamp);
    EXPECT_NEAR(result.odometry.translation.x(), 1.2, 0.001);
  }
}

}  // namespace
}  // namespace maploop::lidar
