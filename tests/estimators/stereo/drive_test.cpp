// These tests run the odometry on the recorded drive and compare it with the reference.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/frames.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/kitti_metric.h"

namespace maploop::stereo {
namespace {

using evaluation::CommonRotation;
using evaluation::Trajectory;
using maploop::testing::drive_0013;

struct DriveResult {
  std::vector<RelativeMotion> motions;
  Trajectory camera;  // poses of the left camera relative to its first pose
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

// Runs the odometry over the whole drive once and keeps the result.
const DriveResult& whole_drive() {
  static const DriveResult run = [] {
    const maploop::sensors::KittiDrive recorded(drive_0013());
    return drive(recorded.calibration().stereo, maploop::testing::read_pairs(recorded));
  }();
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
  const DriveResult& run = whole_drive();
  ASSERT_EQ(run.motions.size(), 144u);
  for (std::size_t i = 1; i < run.motions.size(); ++i) {
    EXPECT_EQ(run.motions[i].status, OdometryStatus::ok) << "pair " << i;
    EXPECT_GE(run.motions[i].inliers, 80) << "pair " << i;
  }
  const Trajectory truth = evaluation::read_kitti_poses(
      maploop::testing::real_data() / "kitti/drive_0013_truth/time_corrected.txt");
  const auto raw = evaluation::score(run.camera, truth, 100.0);
  EXPECT_LT(raw.segment.percent, 1.10);  // reached 0.99; libviso2 1.29
  EXPECT_LT(raw.end_point_m, 2.5);       // reached 2.2; libviso2 2.7
  EXPECT_LT(raw.segment.deg_per_m, 0.0030);
  // The reference's own azimuth differs by 0.5 to 0.75 degrees from every camera and LiDAR
  // odometry.
  const auto aligned = evaluation::score(run.camera, truth, 100.0, CommonRotation::remove);
  EXPECT_GT(aligned.segment.segments, 40);
  EXPECT_LT(aligned.segment.percent, 0.60);  // reached 0.49; libviso2 0.86
  EXPECT_LT(aligned.end_point_m, 0.6);       // reached 0.36
}

TEST_F(DriveTest, FindsTheDisparitiesTooSmallAsTheLidarDoes) {
  const DriveResult& run = whole_drive();
  // Projected LiDAR depth gives 0.30 to 0.48 px.
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
  const Trajectory truth = evaluation::read_kitti_poses(
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
  const auto aligned = evaluation::score(run.camera, kept_truth, 100.0, CommonRotation::remove);
  EXPECT_LT(aligned.segment.percent, 1.2);
}

TEST_F(DriveTest, ACoveredLensIsRefused) {
  auto pairs = maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013()), 8);
  std::fill(pairs[5].right.pixels.begin(), pairs[5].right.pixels.end(), std::uint8_t{0});
  const DriveResult run = drive(camera_, pairs);
  EXPECT_EQ(run.motions[5].status, OdometryStatus::too_few_features);
  EXPECT_EQ(run.motions[6].status, OdometryStatus::ok);
  EXPECT_EQ(run.motions[6].from, pairs[4].stamp);
  EXPECT_NEAR(run.motions[6].translation.x(), 2.4, 0.3);
}

}  // namespace
}  // namespace maploop::stereo
