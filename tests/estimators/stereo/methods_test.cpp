// These tests cover the alternative methods for motion and matching, against known motions and on
// the recorded drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "estimators/stereo/epipolar_motion.h"
#include "estimators/stereo/point_alignment.h"
#include "estimators/stereo/sift_front_end.h"
#include "estimators/stereo/stereo_odometry.h"
#include "msgs/archive.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/estimators/stereo/synthetic_scene.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::stereo {
namespace {

using maploop::testing::all_of;
using maploop::testing::drive_0013;
using maploop::testing::driving_motion;
using maploop::testing::pose_error;
using maploop::testing::small_camera;
using maploop::testing::synthetic_tracks;

TEST(PointAlignment, PerfectPointsGiveTheMotionExactly) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 30, {}, 1);
  const auto aligned = align_points(small_camera(), {}, tracks, all_of(tracks));
  ASSERT_TRUE(aligned);
  EXPECT_LT(pose_error(*aligned, driving_motion()).norm(), 1e-9);
  const Refinement refined = refine_alignment(small_camera(), {}, tracks, all_of(tracks));
  ASSERT_TRUE(refined.ok);
  EXPECT_LT(pose_error(refined.T_previous_current, driving_motion()).norm(), 1e-9);
}

TEST(PointAlignment, TwoPointsAndPointsOnALineAreNoMotion) {
  auto tracks = synthetic_tracks(small_camera(), driving_motion(), 3, {}, 1);
  EXPECT_FALSE(align_points(small_camera(), {}, tracks, std::vector<int>{0, 1}));
  for (std::size_t i = 0; i < 3; ++i)  // along one line of sight
    tracks[i].previous = tracks[i].current = {320.0, 120.0, 320.0 - 5.0 * (1.0 + double(i)), 120.0};
  EXPECT_FALSE(align_points(small_camera(), {}, tracks, all_of(tracks)));
}

// Over many scenes, the covariance must agree with the errors.
TEST(PointAlignment, CovarianceAgreesWithTheErrors) {
  StereoParameters parameters;
  parameters.correlated_pairs = 1.0;
  parameters.sigma_match = 0.0;  // the method assumes independent errors at both epochs
  double nees = 0.0;
  constexpr int scene_count = 200;
  for (unsigned seed = 0; seed < scene_count; ++seed) {
    const auto tracks =
        synthetic_tracks(small_camera(), driving_motion(), 100,
                         {parameters.sigma_track, parameters.sigma_disparity}, seed);
    const Refinement refined = refine_alignment(small_camera(), parameters, tracks, all_of(tracks));
    ASSERT_TRUE(refined.ok);
    const auto error = pose_error(refined.T_previous_current, driving_motion());
    nees += error.dot(refined.covariance.ldlt().solve(error)) / 6.0 / scene_count;
  }
  EXPECT_GT(nees, 0.5);  // the previous left position has no error in these scenes
  EXPECT_LT(nees, 1.3);
}

TEST(EpipolarMotion, PerfectTracksGiveRotationAndDirection) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 60, {}, 1);
  const double length = driving_motion().translation().norm();
  const Refinement found = epipolar_motion(small_camera(), {}, tracks, length);
  ASSERT_TRUE(found.ok);
  EXPECT_LT(pose_error(found.T_previous_current, driving_motion()).norm(), 1e-5);
  EXPECT_GE(std::sqrt(found.covariance(2, 2)), 0.99 * length) << "the length is not seen";
}

TEST(EpipolarMotion, NoiseAndAMovingObjectDoNotMislead) {
  StereoParameters parameters;
  auto tracks =
      synthetic_tracks(small_camera(), driving_motion(), 150, {parameters.sigma_track}, 4);
  for (std::size_t i = 0; i < 40; ++i) tracks[i].current.v_left += 12.0;
  const Refinement found =
      epipolar_motion(small_camera(), parameters, tracks, driving_motion().translation().norm());
  ASSERT_TRUE(found.ok);
  EXPECT_LT(pose_error(found.T_previous_current, driving_motion()).tail<3>().norm(), 0.003);
  EXPECT_LT(pose_error(found.T_previous_current, driving_motion()).head<3>().norm(), 0.05);
  const auto moved =
      std::count_if(found.inliers.begin(), found.inliers.end(), [](int i) { return i < 40; });
  EXPECT_LT(moved, 8) << "those that move along their epipolar lines cannot be told";
}

TEST(SampsonDistance, IsTheDistanceToTheEpipolarLinesOfBothImages) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 20, {}, 2);
  for (const StereoTrack& track : tracks) {
    EXPECT_NEAR(sampson_distance(small_camera(), driving_motion(), track), 0.0, 1e-9);
    StereoTrack off = track;
    off.current.v_left += 0.5;
    EXPECT_LE(std::abs(sampson_distance(small_camera(), driving_motion(), off)), 0.5);
  }
}

TEST(MatchDescriptors, EachOthersNearestAndClearlyNearerThanTheSecond) {
  const cv::Mat first = (cv::Mat_<float>(3, 2) << 0.f, 0.f, 10.f, 0.f, 20.f, 0.f);
  // Feature 0 has one near match, 1 has two equally near ones, and 2 has one that is clearly nearer
  // than the second.
  const cv::Mat second = (cv::Mat_<float>(4, 2) << 0.5f, 0.f, 10.f, 1.f, 10.f, -1.f, 24.f, 0.f);
  const auto pairs = match_descriptors(first, second, 0.8);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0], (std::pair<int, int>(0, 0)));
  EXPECT_EQ(pairs[1], (std::pair<int, int>(2, 3)));
  EXPECT_TRUE(match_descriptors(first, cv::Mat(), 0.8).empty());
}

class MethodsOnTheDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    const sensors::KittiDrive drive(drive_0013());
    camera_ = drive.calibration().stereo;
    pairs_ = maploop::testing::read_pairs(drive, 8);
  }

  void expect_drives(const StereoParameters& parameters, double tolerance) const {
    StereoOdometry odometry(camera_, parameters);
    EXPECT_EQ(odometry.process(pairs_[0]).status, OdometryStatus::first_frame);
    for (std::size_t i = 1; i < pairs_.size(); ++i) {
      const RelativeMotion motion = odometry.process(pairs_[i]);
      ASSERT_EQ(motion.status, OdometryStatus::ok)
          << "pair " << i << ": " << to_string(motion.status);
      EXPECT_NEAR(motion.translation.x(), 1.17, tolerance) << "pair " << i;
      EXPECT_LT(motion.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.02);
    }
  }

  StereoCalibration camera_;
  std::vector<StereoPair> pairs_;
};

TEST_F(MethodsOnTheDrive, PointsToPoints) {
  StereoParameters parameters;
  parameters.motion = MotionMethod::points_to_points;
  expect_drives(parameters, 0.2);
}

TEST_F(MethodsOnTheDrive, ImageToImageTakesTheSpeedItIsTold) {
  StereoParameters parameters;
  parameters.motion = MotionMethod::image_to_image;
  parameters.window_frames = 0;
  parameters.assumed_speed = 11.3;
  expect_drives(parameters, 0.05);
}

TEST_F(MethodsOnTheDrive, SiftMatches) {
  StereoParameters parameters;
  parameters.matching = Matching::sift;
  expect_drives(parameters, 0.2);
}

TEST_F(MethodsOnTheDrive, ASavedSiftOdometryGoesOnWithTheSameBits) {
  StereoParameters parameters;
  parameters.matching = Matching::sift;
  StereoOdometry first(camera_, parameters), second(camera_, parameters);
  for (std::size_t i = 0; i < 3; ++i) first.process(pairs_[i]);
  const Bytes archive = maploop::testing::saved(first);
  EXPECT_LE(archive.size(), first.largest_archive());
  maploop::testing::load(archive, second);
  for (std::size_t i = 3; i < 5; ++i) {
    ArchiveWriter a, b;
    a(first.process(pairs_[i]));
    b(second.process(pairs_[i]));
    EXPECT_EQ(a.content(), b.content()) << "pair " << i;
  }
  StereoOdometry other(camera_, {});
  EXPECT_NE(maploop::testing::refusal(archive, other).find("stereo.matching = \"sift\""),
            std::string::npos);
}

TEST_F(MethodsOnTheDrive, StagesAreNamedAsTheyEnd) {
  StereoOdometry odometry(camera_, {});
  std::vector<std::string> stages;
  odometry.on_stage([&](std::string_view stage) { stages.emplace_back(stage); });
  odometry.process(pairs_[0]);
  EXPECT_EQ(stages, (std::vector<std::string>{"pyramids", "detection"}));
  stages.clear();
  odometry.process(pairs_[1]);
  EXPECT_EQ(stages, (std::vector<std::string>{"pyramids", "tracking", "consensus", "refinement",
                                              "window", "detection"}));
}

TEST(Methods, ANamelessScaleAndAWindowDoNotGoTogether) {
  StereoParameters parameters;
  parameters.motion = MotionMethod::image_to_image;
  EXPECT_THROW(StereoOdometry(small_camera(), parameters), std::invalid_argument);
}

}  // namespace
}  // namespace maploop::stereo
