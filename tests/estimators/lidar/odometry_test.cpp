// These tests check the visual-LiDAR odometer's named statuses for odd scans.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "estimators/lidar/lidar_odometry.h"
#include "estimators/lidar/scan_preparation.h"
#include "tests/estimators/lidar/drive_scans.h"

namespace maploop::lidar {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::read_scans;

// Returns the visual motion of a straight drive.
RelativeMotion visual(Time from, Time to, double speed = 12.8) {
  RelativeMotion motion;
  motion.status = OdometryStatus::ok;
  motion.from = from;
  motion.stamp = to;
  motion.available = to + from_seconds(0.05);
  motion.translation.x() = speed * to_seconds(to - from);
  motion.covariance = Matrix6d::Identity() * 1e-4;
  return motion;
}

class LidarOdometryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    const sensors::KittiDrive drive(drive_0013());
    T_body_velo_ = drive.calibration().T_body_velo;
    scans_ = read_scans(drive, 12);
  }

  LidarOdometry odometry(const LidarParameters& parameters = {}) const {
    return {T_body_velo_, parameters};
  }
  // Returns an odometry that has used scans 0 and 1, so that it has a map.
  LidarOdometry started() const {
    LidarOdometry o = odometry();
    o.process(&scans_[0], nullptr);
    EXPECT_EQ(o.process(&scans_[1], nullptr).lidar.status, OdometryStatus::ok);
    return o;
  }

  Eigen::Isometry3d T_body_velo_;
  std::vector<LidarScan> scans_;
};

TEST_F(LidarOdometryTest, LidarAloneFollowsTheDriveFromItsSecondScanOn) {
  LidarOdometry o = odometry();
  EXPECT_EQ(o.process(&scans_[0], nullptr).odometry.status, OdometryStatus::first_frame);
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const OdometerResult r = o.process(&scans_[i], nullptr);
    ASSERT_EQ(r.odometry.status, OdometryStatus::ok) << i << ": " << to_string(r.odometry.status);
    EXPECT_EQ(r.odometry.source, OdometrySource::lidar);
    EXPECT_EQ(r.odometry.from, scans_[i - 1].stamp);
    EXPECT_EQ(r.odometry.stamp, scans_[i].stamp);
    EXPECT_NEAR(r.odometry.translation.x(), 1.3, 0.15) << i;
  }
}

TEST_F(LidarOdometryTest, PoseIsAtTheVisualMotionsStamp) {
  LidarOdometry o = odometry();
  const Duration after = from_seconds(0.015);
  o.process(&scans_[0], nullptr);
  Time before = scans_[0].stamp;
  for (std::size_t i = 1; i < 4; ++i) {
    const RelativeMotion seen = visual(before, scans_[i].stamp + after);
    const OdometerResult r = o.process(&scans_[i], &seen);
    EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
    // The first scan was smeared, since its motion was unknown; the second one starts the map.
    EXPECT_EQ(r.lidar.status, i == 1 ? OdometryStatus::first_frame : OdometryStatus::ok);
    EXPECT_EQ(r.odometry.source, i == 1 ? OdometrySource::visual : OdometrySource::visual_lidar);
    EXPECT_EQ(r.lidar.stamp, seen.stamp);
    EXPECT_EQ(o.prepared().stamp, seen.stamp);
    before = seen.stamp;
  }
}

TEST_F(LidarOdometryTest, WithoutAScanTheVisualMotionIsPassedOn) {
  LidarOdometry o = started();
  const RelativeMotion seen = visual(scans_[1].stamp, scans_[2].stamp);
  const OdometerResult r = o.process(nullptr, &seen);
  EXPECT_EQ(r.lidar.status, OdometryStatus::bad_input);
  EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
  EXPECT_EQ(r.odometry.source, OdometrySource::visual);
  EXPECT_EQ(r.odometry.translation, seen.translation);
  // The next scan is registered with the map again.
  const RelativeMotion next = visual(scans_[2].stamp, scans_[3].stamp);
  EXPECT_EQ(o.process(&scans_[3], &next).lidar.status, OdometryStatus::ok);
}

TEST_F(LidarOdometryTest, RefusedVisualMotionIsReplacedByTheLastOne) {
  LidarOdometry o = started();
  RelativeMotion refused;
  refused.status = OdometryStatus::too_few_inliers;
  refused.stamp = scans_[2].stamp;
  const OdometerResult r = o.process(&scans_[2], &refused);
  EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
  EXPECT_EQ(r.odometry.source, OdometrySource::lidar);
}

// The first image shows no motion, so the pose at its stamp, half a turn before that of the scan,
// cannot be told.
TEST_F(LidarOdometryTest, RefusedVisualMotionBeforeAnyOtherHasNoPose) {
  RelativeMotion first;
  first.status = OdometryStatus::first_frame;
  first.stamp = scans_[1].start + Duration(1);
  LidarOdometry with_image = odometry(), between = odometry();
  with_image.process(&scans_[0], nullptr);
  const OdometerResult r = with_image.process(&scans_[1], &first);
  EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
  EXPECT_EQ(r.odometry.from, scans_[0].stamp);
  EXPECT_EQ(r.odometry.stamp, scans_[1].stamp);
  EXPECT_NEAR(r.odometry.translation.x(), 1.3, 0.15);

  between.process(&scans_[0], nullptr);
  EXPECT_EQ(between.process(nullptr, &first).odometry.status, OdometryStatus::first_frame);
  EXPECT_EQ(between.process(&scans_[1], nullptr).odometry.translation, r.odometry.translation);
}

TEST_F(LidarOdometryTest, VisualMotionFarFromTheScansIsReportedAsDisagreement) {
  LidarParameters parameters;
  parameters.max_disagreement = 0.05;
  LidarOdometry o = odometry(parameters);
  o.process(&scans_[0], nullptr);
  o.process(&scans_[1], nullptr);
  const RelativeMotion seen = visual(scans_[1].stamp, scans_[2].stamp, 16.0);  // 0.33 m too far
  const OdometerResult r = o.process(&scans_[2], &seen);
  EXPECT_EQ(r.lidar.status, OdometryStatus::disagreement);
  EXPECT_GT(r.lidar.seed_translation_error, 0.2);
  EXPECT_EQ(r.lidar.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(r.odometry.source, OdometrySource::visual);
}

TEST_F(LidarOdometryTest, EmptyTinyAndNanScansAreRefusedAndTheNextIsUsed) {
  LidarOdometry o = started();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  LidarScan odd = scans_[2];
  odd.points.clear();
  EXPECT_EQ(o.process(&odd, nullptr).odometry.status, OdometryStatus::too_few_features);
  odd = scans_[3];
  odd.points.resize(100);
  EXPECT_EQ(o.process(&odd, nullptr).odometry.status, OdometryStatus::too_few_features);
  odd = scans_[4];
  for (LidarPoint& p : odd.points) p.y = nan;
  EXPECT_EQ(o.process(&odd, nullptr).odometry.status, OdometryStatus::too_few_features);
  const OdometerResult r = o.process(&scans_[5], nullptr);
  EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
  EXPECT_NEAR(o.pose().translation().x(), 6.4, 0.5);  // no jump: five intervals of 1.3 m
}

TEST_F(LidarOdometryTest, DuplicateAndOlderScansAreBadInputAndChangeNothing) {
  LidarOdometry o = started();
  const Eigen::Isometry3d pose = o.pose();
  EXPECT_EQ(o.process(&scans_[1], nullptr).odometry.status, OdometryStatus::bad_input);
  EXPECT_EQ(o.process(&scans_[0], nullptr).odometry.status, OdometryStatus::bad_input);
  EXPECT_EQ(o.pose().matrix(), pose.matrix());
  EXPECT_EQ(o.process(&scans_[2], nullptr).odometry.status, OdometryStatus::ok);
}

TEST_F(LidarOdometryTest, TimeSetBackForGoodStartsAnew) {
  LidarParameters parameters;
  LidarOdometry o = odometry(parameters);
  o.process(&scans_[10], nullptr);
  for (int i = 0; i < parameters.max_stale_scans - 1; ++i) {
    EXPECT_EQ(o.process(&scans_[0], nullptr).lidar.status, OdometryStatus::bad_input);
  }
  EXPECT_EQ(o.process(&scans_[0], nullptr).lidar.status, OdometryStatus::first_frame);
  EXPECT_EQ(o.process(&scans_[1], nullptr).lidar.status, OdometryStatus::ok);
}

TEST_F(LidarOdometryTest, StampsThatAreNotOfOneTurnAreBadInput) {
  LidarOdometry o = started();
  LidarScan odd = scans_[2];
  std::swap(odd.start, odd.end);
  EXPECT_EQ(o.process(&odd, nullptr).lidar.status, OdometryStatus::bad_input);
  const RelativeMotion later = visual(scans_[1].stamp, scans_[4].stamp);
  const OdometerResult r = o.process(&scans_[2], &later);
  EXPECT_EQ(r.lidar.status, OdometryStatus::bad_input);
  EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
  EXPECT_EQ(r.odometry.source, OdometrySource::visual);
}

TEST_F(LidarOdometryTest, StandingVehicleStands) {
  LidarOdometry o = odometry();
  LidarScan same = scans_[0];
  for (int i = 0; i < 5; ++i) {
    const OdometerResult r = o.process(&same, nullptr);
    if (i > 0) {
      EXPECT_EQ(r.odometry.status, OdometryStatus::ok);
      EXPECT_LT(r.odometry.translation.norm(), 2e-3);
    }
    for (Time* t : {&same.start, &same.stamp, &same.end}) *t += from_seconds(0.1);
  }
}

TEST_F(LidarOdometryTest, LongGapStartsAnew) {
  LidarOdometry o = started();
  LidarScan later = scans_[2];
  for (Time* t : {&later.start, &later.stamp, &later.end}) *t += from_seconds(5.0);
  EXPECT_EQ(o.process(&later, nullptr).lidar.status, OdometryStatus::first_frame);
}

TEST_F(LidarOdometryTest, TwoThreadsGiveTheBitsOfOne) {
  const ForEachChunk in_two_threads = [](int count, const std::function<void(int)>& work) {
    std::thread other([&] {
      for (int i = 1; i < count; i += 2) work(i);
    });
    for (int i = 0; i < count; i += 2) work(i);
    other.join();
  };
  LidarOdometry one = odometry();
  LidarOdometry two(T_body_velo_, {}, in_two_threads);
  for (std::size_t i = 0; i < 4; ++i) {
    const OdometerResult a = one.process(&scans_[i], nullptr);
    const OdometerResult b = two.process(&scans_[i], nullptr);
    EXPECT_EQ(a.lidar.status, b.lidar.status);
    EXPECT_EQ(a.lidar.translation, b.lidar.translation);
    EXPECT_EQ(a.lidar.rotation.coeffs(), b.lidar.rotation.coeffs());
    EXPECT_EQ(a.lidar.covariance, b.lidar.covariance);
  }
}

TEST(LidarParametersTest, WhatCannotBeUsedIsNamed) {
  LidarParameters parameters;
  parameters.kernel = 0.0;
  try {
    const LidarOdometry refused(Eigen::Isometry3d::Identity(), parameters);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("kernel"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace maploop::lidar
