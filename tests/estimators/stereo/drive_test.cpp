// The odometry on the recorded drive, against its reference.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/frames.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/estimators/stereo/kitti_error.h"
#include "tests/support/real_data.h"

namespace maploop::stereo {
namespace {

using maploop::testing::drive_0013;
using maploop::testing::Trajectory;

struct DriveResult {
  std::vector<RelativeMotion> motions;
  Trajectory camera;  // poses of the left camera in its first one
  double disparity_offset = 0.0;
};

DriveResult drive(const StereoCalibration& camera, const std::vector<StereoPair>& pairs) {
  DriveResult run;
  StereoOdometry odometry(camera, StereoParameters{});
  Eigen::Isometry3d T_start_body = Eigen::Isometry3d::Identity();
  for (const StereoPair& pair : pairs) {
    run.motions.push_back(odometry.process(pair));
    T_start_body = T_start_body * run.motions.back().T_from_to();
    run.camera.push_back(camera.T_body_cam.inverse() * T_start_body * camera.T_body_cam);
  }
  run.disparity_offset = odometry.disparity_offset();
  return run;
}

class DriveTest : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    MAPLOOP_REQUIRE_REAL_DATA();
    camera_ = maploop::sensors::KittiDrive(drive_0013()).calibration().stereo;
  }

  StereoCalibration camera_;
};

TEST_F(DriveTest, FollowsTheReferenceBetterThanLibviso2) {
  const DriveResult run =
      drive(camera_, maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013())));
  ASSERT_EQ(run.motions.size(), 144u);
  for (std::size_t i = 1; i < run.motions.size(); ++i) {
    EXPECT_EQ(run.motions[i].status, OdometryStatus::ok) << "pair " << i;
    EXPECT_GE(run.motions[i].inliers, 80) << "pair " << i;
  }
  const Trajectory truth = maploop::testing::read_kitti_poses(
      maploop::testing::real_data() / "kitti/drive_0013_truth/time_corrected.txt");
  const auto raw = maploop::testing::kitti_error(run.camera, truth, 100.0);
  EXPECT_LT(raw.translation, 0.0110);  // reached 0.0099; libviso2 0.0129
  EXPECT_LT(raw.end_point, 2.5);       // reached 2.2 m; libviso2 2.7 m
  EXPECT_LT(degrees(raw.rotation), 0.0030);
  // The reference's own azimuth is 0.5 to 0.75 degrees off for every camera and LiDAR odometry.
  const auto aligned = maploop::testing::kitti_error(
      maploop::testing::without_common_rotation(run.camera, truth), truth, 100.0);
  EXPECT_GT(aligned.segments, 40);
  EXPECT_LT(aligned.translation, 0.0060);  // reached 0.0049; libviso2 0.0086
  EXPECT_LT(aligned.end_point, 0.6);       // reached 0.36 m
}

TEST_F(DriveTest, FindsTheDisparitiesTooSmallAsTheLidarDoes) {
  const DriveResult run =
      drive(camera_, maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013())));
  // Projected LiDAR depth says 0.30 to 0.48 px.
  EXPECT_GT(run.disparity_offset, 0.15);
  EXPECT_LT(run.disparity_offset, 0.5);
}

TEST_F(DriveTest, SamePairsGiveTheSameBitsWithAnyNumberOfOpenCvThreads) {
  const auto pairs = maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013()), 40);
  cv::setNumThreads(1);
  const DriveResult one = drive(camera_, pairs);
  cv::setNumThreads(4);
  const DriveResult four = drive(camera_, pairs);
  cv::setNumThreads(1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(one.motions[i].translation, four.motions[i].translation) << "pair " << i;
    EXPECT_EQ(one.motions[i].rotation.coeffs(), four.motions[i].rotation.coeffs()) << "pair " << i;
    EXPECT_EQ(one.motions[i].covariance, four.motions[i].covariance) << "pair " << i;
    EXPECT_EQ(one.motions[i].inliers, four.motions[i].inliers) << "pair " << i;
  }
}

TEST_F(DriveTest, LosingEveryOtherPairCostsLittle) {
  std::vector<StereoPair> pairs =
      maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013()));
  const Trajectory truth = maploop::testing::read_kitti_poses(
      maploop::testing::real_data() / "kitti/drive_0013_truth/time_corrected.txt");
  std::vector<StereoPair> kept;
  Trajectory kept_truth;
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    kept.push_back(std::move(pairs[i]));
    kept_truth.push_back(truth[i]);
  }
  const DriveResult run = drive(camera_, kept);
  for (std::size_t i = 1; i < run.motions.size(); ++i)
    EXPECT_EQ(run.motions[i].status, OdometryStatus::ok) << "pair " << i;
  const auto aligned = maploop::testing::kitti_error(
      maploop::testing::without_common_rotation(run.camera, kept_truth), kept_truth, 100.0);
  EXPECT_LT(aligned.translation, 0.012);
}

TEST_F(DriveTest, SwappedCamerasAndCoveredLensAreRefusedByName) {
  auto pairs = maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013()), 8);
  std::swap(pairs[3].left, pairs[3].right);
  std::fill(pairs[5].right.pixels.begin(), pairs[5].right.pixels.end(), std::uint8_t{0});
  const DriveResult run = drive(camera_, pairs);
  EXPECT_EQ(run.motions[3].status, OdometryStatus::too_few_features);
  EXPECT_EQ(run.motions[5].status, OdometryStatus::too_few_features);
  for (const std::size_t i : {4u, 6u}) {
    EXPECT_EQ(run.motions[i].status, OdometryStatus::ok) << "pair " << i;
    EXPECT_EQ(run.motions[i].from, pairs[i - 2].stamp);
    EXPECT_NEAR(run.motions[i].translation.x(), 2.4, 0.3);
  }
}

}  // namespace
}  // namespace maploop::stereo
