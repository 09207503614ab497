// Disparities against LiDAR depth: on a made wall, and on the recorded drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "estimators/lidar/disparity_from_depth.h"
#include "estimators/lidar/scan_preparation.h"
#include "estimators/stereo/detect.h"
#include "estimators/stereo/stereo_match.h"
#include "estimators/stereo/stereo_odometry.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tests/estimators/stereo/drive_pairs.h"

namespace maploop::lidar {
namespace {

using maploop::testing::drive_0013;

StereoCalibration made_camera() {
  StereoCalibration camera;
  camera.width = 1242;
  camera.height = 375;
  camera.fx = camera.fy = 720.0;
  camera.cx = 620.0;
  camera.cy = 187.0;
  camera.baseline = 0.54;
  camera.T_body_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return camera;
}

// A wall across the road at 15 m, seen by both.
PreparedScan wall() {
  PreparedScan scan;
  for (int y = -60; y <= 60; ++y) {
    for (int z = -15; z <= 15; ++z) {
      scan.points.push_back({{15.0f, 0.2f * static_cast<float>(y), 0.2f * static_cast<float>(z)},
                             {1.0f, 0.0f, 0.0f}});
    }
  }
  return scan;
}

std::vector<DisparityFeature> features_of_wall(double missing) {
  std::vector<DisparityFeature> features;
  for (double u = 200.0; u < 1050.0; u += 37.0) {
    for (double v = 100.0; v < 270.0; v += 31.0) {
      features.push_back({u, v, 720.0 * 0.54 / 15.0 - missing});
    }
  }
  return features;
}

TEST(DisparityFromDepth, FindsWhatIsMissing) {
  DisparityFromDepth check(made_camera(), {});
  const auto found = check.measure(wall(), features_of_wall(0.37));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, 0.37, 1e-5);
  EXPECT_GT(found->features, 100);
  EXPECT_LT(found->variance, 0.03 * 0.03);
}

TEST(DisparityFromDepth, WrongMatchesAndOtherDepthsAreNotBelieved) {
  auto features = features_of_wall(0.37);
  for (std::size_t i = 0; i < features.size(); i += 4) features[i].disparity += 1.4;
  PreparedScan scan = wall();
  // A post 5 m before the wall: features beside it have two depths.
  for (int z = -15; z <= 15; ++z) {
    scan.points.push_back({{10.0f, 1.0f, 0.2f * static_cast<float>(z)}, {1.0f, 0.0f, 0.0f}});
  }
  DisparityFromDepth check(made_camera(), {});
  const auto found = check.measure(scan, features);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, 0.37, 0.05);
}

TEST(DisparityFromDepth, WithoutScanOrFeaturesThereIsNothing) {
  DisparityFromDepth check(made_camera(), {});
  EXPECT_FALSE(check.measure({}, features_of_wall(0.3)));
  EXPECT_FALSE(check.measure(wall(), {}));
}

// Each fifth scan and pair of the drive. Measured before by others with another association of
// features and points: 0.30 to 0.48 px.
TEST(DisparityFromDepth, FindsTheOffsetOfTheRecordedDrive) {
  MAPLOOP_REQUIRE_DRIVE();
  cv::setNumThreads(1);
  const sensors::KittiDrive drive(drive_0013());
  const StereoCalibration camera = drive.calibration().stereo;
  const auto pairs = maploop::testing::read_pairs(drive);
  const auto scans = maploop::testing::read_scans(drive, pairs.size());
  LidarParameters fine;
  fine.sample_voxel = 0.2;
  fine.max_samples = 131'072;
  ScanPreparation preparation(drive.calibration().T_body_velo, fine);
  DisparityFromDepth check(camera, {});
  stereo::StereoOdometry odometry(camera, {});
  stereo::StereoParameters parameters;
  parameters.features_per_bucket = 8;
  std::vector<double> found;
  double information = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const RelativeMotion motion = odometry.process(pairs[i]);
    if (i % 5 != 4 || motion.status != OdometryStatus::ok) continue;
    stereo::StereoFrame frame;
    frame.left.build(pairs[i].left, parameters);
    frame.right.build(pairs[i].right, parameters);
    std::vector<cv::Point2f> corners;
    std::vector<stereo::StereoObservation> matched;
    stereo::CornerDetector(parameters).detect(frame.left, {}, &corners);
    stereo::match_new_corners(frame, parameters, corners, &matched);
    std::vector<DisparityFeature> features;
    for (const auto& seen : matched)
      features.push_back({seen.u_left, seen.v_left, seen.disparity()});
    PreparedScan prepared;
    preparation.prepare(scans[i], motion.stamp,
                        Twist::of(motion.T_from_to(), to_seconds(motion.stamp - motion.from)),
                        &prepared);
    const auto measured = check.measure(prepared, features);
    if (!measured) continue;  // corners stand at edges: few have one depth
    std::printf("pair %3zu: %.3f +- %.3f px from %d of %zu features\n", i, measured->value,
                std::sqrt(measured->variance), measured->features, features.size());
    found.push_back(measured->value);
    sum += measured->value / measured->variance;
    information += 1.0 / measured->variance;
  }
  ASSERT_GE(found.size(), 14u) << "of 28";
  const double mean = sum / information;
  std::printf("all: %.3f +- %.3f px; stereo odometry's own: %.3f px\n", mean,
              1.0 / std::sqrt(information), odometry.disparity_offset());
  EXPECT_GT(mean, 0.25);
  EXPECT_LT(mean, 0.5);
  // The pairs scatter by more than each says of itself (see the header): printed, not judged.
  double square = 0.0;
  for (const double value : found) square += (value - mean) * (value - mean);
  std::printf("pairs scatter by %.3f px\n", std::sqrt(square / static_cast<double>(found.size())));
}

}  // namespace
}  // namespace maploop::lidar
