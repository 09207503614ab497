// These tests compare motions between consecutive scans with those of PCL's GICP on the same
// samples.
#include <gtest/gtest.h>

#include "estimators/lidar/gicp.h"
#include "estimators/lidar/scan_preparation.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tools/odometry/pcl_registration.h"

namespace maploop::lidar {
namespace {

TEST(PclReference, MotionsBetweenScansAgree) {
  MAPLOOP_REQUIRE_DRIVE();
  const sensors::KittiDrive drive(maploop::testing::drive_0013());
  const auto scans = maploop::testing::read_scans(drive, 4);
  LidarParameters parameters = maploop::testing::lidar_parameters(drive);
  parameters.sample_voxel = 0.5;
  const Twist motion{{12.5, 0.0, 0.0}, Eigen::Vector3d::Zero()};
  Eigen::Isometry3d seed = Eigen::Isometry3d::Identity();
  seed.translation().x() = 1.25;
  odometry::PclRegistration reference(odometry::Method::pcl_gicp);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    PreparedScan target, source;
    ScanPreparation preparation(drive.calibration().T_body_velo, parameters);
    preparation.prepare(scans[i - 1], scans[i - 1].stamp, motion, &target);
    preparation.prepare(scans[i], scans[i].stamp, motion, &source);
    LocalMap map(parameters);
    map.insert(target, Eigen::Isometry3d::Identity());
    const Alignment ours = Gicp(parameters).align(map, source, seed, true);
    const auto theirs = reference.align(source.points, target.points, seed);
    ASSERT_EQ(ours.status, OdometryStatus::ok);
    ASSERT_TRUE(theirs.converged);
    const Eigen::Isometry3d difference = ours.T_map_body.inverse() * theirs.T_target_source;
    EXPECT_LT(difference.translation().norm(), 0.05) << "scan " << i;
    EXPECT_LT(Eigen::AngleAxisd(difference.linear()).angle(), 0.0035) << "scan " << i;  // 0.2 deg
  }
}

}  // namespace
}  // namespace maploop::lidar
