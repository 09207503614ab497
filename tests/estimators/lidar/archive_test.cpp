// An odometry saved in the middle of the recorded drive continues with the same bits.
#include <gtest/gtest.h>

#include "estimators/lidar/lidar_odometry.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tests/support/broken_archives.h"

namespace maploop::lidar {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::load;
using maploop::testing::read_scans;
using maploop::testing::refusal;
using maploop::testing::saved;

void expect_same_bits(const OdometerResult& a, const OdometerResult& b) {
  ArchiveWriter of_a, of_b;
  of_a(a.lidar, a.odometry);
  of_b(b.lidar, b.odometry);
  EXPECT_EQ(of_a.content(), of_b.content()) << "scan " << a.lidar.sequence;
}

class LidarArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    const sensors::KittiDrive drive(drive_0013());
    T_body_velo_ = drive.calibration().T_body_velo;
    scans_ = read_scans(drive, 40);
  }

  LidarOdometry after(std::size_t count) const {
    LidarOdometry odometry(T_body_velo_, {});
    for (std::size_t i = 0; i < count; ++i) odometry.process(&scans_[i], nullptr);
    return odometry;
  }

  Eigen::Isometry3d T_body_velo_ = Eigen::Isometry3d::Identity();
  std::vector<LidarScan> scans_;
};

TEST_F(LidarArchive, ALoadedOdometryGoesOnWithTheSameBits) {
  LidarOdometry first = after(20);
  const Bytes archive = saved(first);
  EXPECT_LT(archive.size(), 1'500'000u);
  EXPECT_LT(archive.size(), first.largest_archive());
  LidarOdometry second = after(3);  // loading replaces its state
  load(archive, second);
  EXPECT_EQ(saved(second), archive);
  for (std::size_t i = 20; i < scans_.size(); ++i) {
    const OdometerResult result = first.process(&scans_[i], nullptr);
    EXPECT_EQ(result.lidar.status, OdometryStatus::ok);
    expect_same_bits(result, second.process(&scans_[i], nullptr));
  }
  EXPECT_EQ(saved(first), saved(second));
}

TEST_F(LidarArchive, SavedBeforeTheFirstScanAndAfterARefusedOne) {
  scans_.resize(8);
  scans_[4].points.clear();
  for (const std::size_t at : {0u, 1u, 5u}) {
    LidarOdometry first = after(at), second = after(0);
    load(saved(first), second);
    for (std::size_t i = at; i < scans_.size(); ++i) {
      expect_same_bits(first.process(&scans_[i], nullptr), second.process(&scans_[i], nullptr));
    }
  }
}

TEST_F(LidarArchive, RefusesOtherParametersAndAnotherMountingByName) {
  const LidarOdometry odometry = after(1);
  LidarParameters parameters;
  parameters.max_speed += 1.0;
  LidarOdometry other(T_body_velo_, parameters);
  EXPECT_NE(refusal(saved(odometry), other).find("max_speed = "), std::string::npos);
  Eigen::Isometry3d moved = T_body_velo_;
  moved.translation().x() += 0.1;
  LidarOdometry another(moved, {});
  EXPECT_NE(refusal(saved(odometry), another).find("another mounting"), std::string::npos);
}

TEST_F(LidarArchive, RefusesBrokenArchivesAndStaysAsItWas) {
  const Bytes archive = saved(after(3));
  LidarOdometry odometry = after(5);
  maploop::testing::expect_refuses_broken(archive, odometry);
  EXPECT_EQ(odometry.process(&scans_[5], nullptr).lidar.status, OdometryStatus::ok);
}

}  // namespace
}  // namespace maploop::lidar
