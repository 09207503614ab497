// Scans of the recorded drive are made odd by cutting and repeating. They must cause no crash and
// no jump, and have a named status.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "estimators/lidar/lidar_odometry.h"
#include "tests/estimators/lidar/drive_scans.h"

namespace maploop::lidar {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::read_scans;

bool says(const LidarMotion& motion, MotionDirection direction) {
  return (motion.degenerate >> static_cast<unsigned>(direction) & 1u) != 0;
}

class OddScans : public ::testing::Test {
 protected:
  static constexpr std::size_t count = 25;

  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    const sensors::KittiDrive drive(drive_0013());
    T_body_velo_ = drive.calibration().T_body_velo;
    scans_ = read_scans(drive, count);
    LidarOdometry whole(T_body_velo_, {});
    for (const LidarScan& scan : scans_) {
      motions_.push_back(whole.process(&scan, nullptr).lidar);
      motions_.back().source = OdometrySource::visual;  // as a good camera would measure
      motions_.back().covariance = Matrix6d::Identity() * 1e-4;
    }
  }

  // Processes only points for which `keep` holds, seeded by the motions of the whole scans.
  std::vector<OdometerResult> cut(const std::function<bool(const LidarPoint&)>& keep) {
    LidarOdometry odometry(T_body_velo_, {});
    std::vector<OdometerResult> results;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      LidarScan scan = scans_[i];
      std::erase_if(scan.points, [&](const LidarPoint& p) { return !keep(p); });
      RelativeMotion visual = motions_[i];
      if (i == 0) visual.status = OdometryStatus::first_frame;
      results.push_back(odometry.process(&scan, &visual));
    }
    return results;
  }

  void expect_no_jump(const std::vector<OdometerResult>& results, double metres) {
    for (std::size_t i = 1; i < results.size(); ++i) {
      EXPECT_EQ(results[i].odometry.status, OdometryStatus::ok) << "scan " << i;
      EXPECT_LT((results[i].odometry.translation - motions_[i].translation).norm(), metres)
          << "scan " << i << ": " << to_string(results[i].lidar.status);
    }
  }

  Eigen::Isometry3d T_body_velo_ = Eigen::Isometry3d::Identity();
  std::vector<LidarScan> scans_;
  std::vector<LidarMotion> motions_;
};

// Only two walls and the road remain; objects ahead, behind and on the road are removed.
TEST_F(OddScans, TunnelKeepsTheVisualMotionAlong) {
  const auto results = cut([](const LidarPoint& p) {
    const bool wall = std::abs(p.y) > 5.0f && p.z > 0.5f;
    return std::abs(p.x) < 12.0f && (wall || p.z < -1.5f);
  });
  expect_no_jump(results, 0.1);
  int named = 0, ok = 0;
  for (std::size_t i = 2; i < results.size(); ++i) {
    ok += results[i].lidar.status == OdometryStatus::ok;
    named += says(results[i].lidar, MotionDirection::along);
    EXPECT_FALSE(says(results[i].lidar, MotionDirection::up)) << "scan " << i;
  }
  EXPECT_GE(ok, 20);
  EXPECT_GE(named, 12);  // parked cars and house corners determine it at times
}

// Only the road remains.
TEST_F(OddScans, OpenFieldDeterminesHeightRollAndPitchAlone) {
  const auto results = cut([](const LidarPoint& p) {
    return p.z < -1.55f && std::abs(p.y) < 4.0f && std::abs(p.x) < 25.0f;
  });
  expect_no_jump(results, 0.1);
  for (std::size_t i = 2; i < results.size(); ++i) {
    const LidarMotion& motion = results[i].lidar;
    if (motion.status != OdometryStatus::ok) continue;
    EXPECT_TRUE(says(motion, MotionDirection::along)) << "scan " << i;
    EXPECT_FALSE(says(motion, MotionDirection::up)) << "scan " << i;
  }
}

TEST_F(OddScans, HugeScanIsThinnedAndUsed) {
  LidarOdometry odometry(T_body_velo_, {});
  for (std::size_t i = 0; i < 4; ++i) {
    LidarScan scan = scans_[i];
    const std::vector<LidarPoint> once = scan.points;
    for (int k = 0; k < 5; ++k) scan.points.insert(scan.points.end(), once.begin(), once.end());
    const LidarMotion motion = odometry.process(&scan, nullptr).lidar;
    if (i == 0) continue;
    ASSERT_EQ(motion.status, OdometryStatus::ok);
    EXPECT_GT(odometry.prepared().left_out, 100'000);
    EXPECT_LT((motion.translation - motions_[i].translation).norm(), i == 1 ? 0.1 : 0.05);
  }
}

// Half of the turn is missing, as behind a wall of rain or a cover.
TEST_F(OddScans, HalfATurnIsEnough) {
  expect_no_jump(cut([](const LidarPoint& p) { return p.y > 0.0f; }), 0.1);
}

}  // namespace
}  // namespace maploop::lidar
