// After warm-up, no scan causes an allocation, whatever is wrong with it.
#include <gtest/gtest.h>

#include "estimators/lidar/lidar_odometry.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tests/support/counted_allocations.h"

namespace maploop::lidar {
namespace {

TEST(LidarAllocation, ScansAfterTheFirstFewAllocateNothing) {
  MAPLOOP_REQUIRE_DRIVE();
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  const sensors::KittiDrive drive(maploop::testing::drive_0013());
  std::vector<LidarScan> scans = maploop::testing::read_scans(drive, 60);
  scans[30].points.clear();
  scans[40].points.resize(1000);
  LidarOdometry odometry(drive.calibration().T_body_velo, {});
  // The buffers have their final size after the largest scan.
  for (std::size_t i = 0; i < 20; ++i) odometry.process(&scans[i], nullptr);
  const long before = maploop::testing::thread_allocations();
  int used = 0;
  for (std::size_t i = 20; i < scans.size(); ++i) {
    used += odometry.process(&scans[i], nullptr).lidar.status == OdometryStatus::ok;
  }
  EXPECT_EQ(maploop::testing::thread_allocations() - before, 0);
  EXPECT_EQ(used, 38);
}

}  // namespace
}  // namespace maploop::lidar
