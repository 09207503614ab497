// These tests cover good, odd and broken input on generated images.
#include <gtest/gtest.h>

#include <stdexcept>

#include "estimators/stereo/stereo_odometry.h"
#include "tests/estimators/stereo/synthetic_scene.h"
#include "tests/estimators/stereo/textured_pair.h"

namespace maploop::stereo {
namespace {

using maploop::testing::small_camera;
using maploop::testing::TexturedWall;

constexpr double wall_disparity = 20.0;  // px, the wall is 10 m away

class StereoOdometryTest : public ::testing::Test {
 protected:
  StereoPair at(int tenths, double moved, double disparity = wall_disparity) const {
    StereoPair pair = wall_.pair(640, 240, moved, disparity);
    pair.stamp = Time(std::chrono::seconds(1000) + std::chrono::milliseconds(100 * tenths));
    pair.available = pair.stamp + std::chrono::milliseconds(20);
    pair.sequence = static_cast<std::uint64_t>(tenths);
    return pair;
  }

  static StereoPair black(StereoPair pair) {
    std::fill(pair.left.pixels.begin(), pair.left.pixels.end(), std::uint8_t{0});
    std::fill(pair.right.pixels.begin(), pair.right.pixels.end(), std::uint8_t{0});
    return pair;
  }

  static void expect_refused(const RelativeMotion& result, OdometryStatus status) {
    EXPECT_EQ(result.status, status) << to_string(result.status);
    EXPECT_TRUE(result.translation.isZero());
    EXPECT_TRUE(result.rotation.isApprox(Eigen::Quaterniond::Identity()));
    EXPECT_TRUE(result.covariance.isZero());
  }

  // Moving the wall one pixel to the left is equivalent to moving the camera B / d to the right.
  static void expect_sideways(const RelativeMotion& result, double pixels) {
    ASSERT_EQ(result.status, OdometryStatus::ok) << to_string(result.status);
    const Eigen::Vector3d expected(pixels * 0.5 / wall_disparity, 0.0, 0.0);
    EXPECT_LT((result.translation - expected).norm(), 0.02) << result.translation.transpose();
    EXPECT_GT(result.covariance.diagonal().minCoeff(), 0.0);
    EXPECT_TRUE(result.covariance.allFinite());
  }

  TexturedWall wall_;
  StereoOdometry odometry_{small_camera(), StereoParameters{}};
};

TEST_F(StereoOdometryTest, FirstPairHasNothingToCompareWith) {
  const RelativeMotion result = odometry_.process(at(0, 0.0));
  expect_refused(result, OdometryStatus::first_frame);
}

TEST_F(StereoOdometryTest, CarriesThePairsStampsAndTheStampItComparesWith) {
  odometry_.process(at(0, 0.0));
  const StereoPair pair = at(1, 4.0);
  const RelativeMotion result = odometry_.process(pair);
  expect_sideways(result, 4.0);
  EXPECT_EQ(result.stamp, pair.stamp);
  EXPECT_EQ(result.available, pair.available);
  EXPECT_EQ(result.sequence, pair.sequence);
  EXPECT_EQ(result.from, at(0, 0.0).stamp);
  EXPECT_GE(result.tracked, result.inliers);
  EXPECT_GT(result.inliers, 100);
}

TEST_F(StereoOdometryTest, RepeatedImageIsRefusedAndTheNextComparesWithTheFirst) {
  odometry_.process(at(0, 0.0));
  expect_refused(odometry_.process(at(1, 0.0)), OdometryStatus::repeated_image);
  const RelativeMotion result = odometry_.process(at(2, 4.0));
  expect_sideways(result, 4.0);
  EXPECT_EQ(result.from, at(0, 0.0).stamp);
}

TEST_F(StereoOdometryTest, BlackPairIsRefusedAndTheNextComparesWithTheOneBefore) {
  odometry_.process(at(0, 0.0));
  expect_refused(odometry_.process(black(at(1, 3.0))), OdometryStatus::too_dark);
  const RelativeMotion result = odometry_.process(at(2, 6.0));
  expect_sideways(result, 6.0);
  EXPECT_EQ(result.from, at(0, 0.0).stamp);
}

TEST_F(StereoOdometryTest, BlackPairsAreNothingToCompareWith) {
  for (int i = 0; i < 4; ++i)
    expect_refused(odometry_.process(black(at(i, 0.0))), OdometryStatus::too_dark);
  expect_refused(odometry_.process(at(4, 0.0)), OdometryStatus::first_frame);
}

TEST_F(StereoOdometryTest, SwappedCamerasAreRefused) {
  odometry_.process(at(0, 0.0));
  StereoPair swapped = at(1, 3.0);
  std::swap(swapped.left, swapped.right);
  const RelativeMotion result = odometry_.process(swapped);
  // A wall with a repeating texture leaves a few false matches.
  EXPECT_TRUE(result.status == OdometryStatus::swapped_images ||
              result.status == OdometryStatus::too_few_inliers)
      << to_string(result.status);
  expect_refused(result, result.status);
  expect_sideways(odometry_.process(at(2, 6.0)), 6.0);
}

TEST_F(StereoOdometryTest, CamerasSwappedFromTheStartNeverGiveAMotion) {
  for (int i = 0; i < 3; ++i) {
    StereoPair swapped = at(i, 3.0 * i);
    std::swap(swapped.left, swapped.right);
    EXPECT_NE(odometry_.process(swapped).status, OdometryStatus::ok);
  }
}

TEST_F(StereoOdometryTest, DroppedPairIsALongerStep) {
  odometry_.process(at(0, 0.0));
  expect_sideways(odometry_.process(at(1, 3.0)), 3.0);
  const RelativeMotion result = odometry_.process(at(3, 9.0));
  expect_sideways(result, 6.0);
  EXPECT_EQ(result.from, at(1, 0.0).stamp);
}

TEST_F(StereoOdometryTest, TimeThatDoesNotIncreaseIsRefusedAndForgotten) {
  odometry_.process(at(5, 0.0));
  expect_refused(odometry_.process(at(5, 3.0)), OdometryStatus::bad_input);
  expect_refused(odometry_.process(at(4, 3.0)), OdometryStatus::bad_input);
  const RelativeMotion result = odometry_.process(at(6, 3.0));
  expect_sideways(result, 3.0);
  EXPECT_EQ(result.from, at(5, 0.0).stamp);
}

TEST_F(StereoOdometryTest, ClockSetBackIsAcceptedAfterAWhile) {
  odometry_.process(at(1000, 0.0));
  const int stale = StereoParameters{}.max_stale_pairs;
  for (int i = 0; i + 1 < stale; ++i)
    expect_refused(odometry_.process(at(i, 0.0)), OdometryStatus::bad_input);
  expect_refused(odometry_.process(at(stale, 0.0)), OdometryStatus::first_frame);
  expect_sideways(odometry_.process(at(stale + 1, 2.0)), 2.0);
}

TEST_F(StereoOdometryTest, LongPauseStartsAnew) {
  odometry_.process(at(0, 0.0));
  expect_refused(odometry_.process(at(50, 3.0)), OdometryStatus::first_frame);
  expect_sideways(odometry_.process(at(51, 6.0)), 3.0);
}

TEST_F(StereoOdometryTest, WrongSizeEmptyAndCutImagesAreRefused) {
  odometry_.process(at(0, 0.0));
  StereoPair smaller = wall_.pair(320, 240, 0.0, wall_disparity);
  smaller.stamp = at(1, 0.0).stamp;
  expect_refused(odometry_.process(smaller), OdometryStatus::bad_input);
  StereoPair empty;
  empty.stamp = at(2, 0.0).stamp;
  expect_refused(odometry_.process(empty), OdometryStatus::bad_input);
  StereoPair cut = at(3, 0.0);
  cut.right.pixels.resize(cut.right.pixels.size() / 2);
  expect_refused(odometry_.process(cut), OdometryStatus::bad_input);
  expect_sideways(odometry_.process(at(4, 6.0)), 6.0);
}

TEST_F(StereoOdometryTest, MotionNoVehicleMakesIsRefusedAndThePairIsComparedWithNext) {
  odometry_.process(at(0, 0.0));
  expect_sideways(odometry_.process(at(1, 1.0)), 1.0);
  expect_refused(odometry_.process(at(2, 11.0)), OdometryStatus::implausible);  // 22 m/s^2
  const RelativeMotion result = odometry_.process(at(3, 14.0));
  expect_sideways(result, 3.0);
  EXPECT_EQ(result.from, at(2, 0.0).stamp);
}

TEST_F(StereoOdometryTest, OtherSceneIsRefused) {
  odometry_.process(at(0, 0.0));
  EXPECT_NE(odometry_.process(at(1, 1300.0)).status, OdometryStatus::ok);
  expect_sideways(odometry_.process(at(2, 1303.0)), 3.0);
}

TEST_F(StereoOdometryTest, RefusesCalibrationAndParametersItCannotUse) {
  const auto message_of = [](const StereoCalibration& camera, const StereoParameters& parameters) {
    try {
      StereoOdometry odometry(camera, parameters);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  StereoCalibration camera = small_camera();
  camera.baseline = -0.5;
  EXPECT_NE(message_of(camera, {}).find("baseline"), std::string::npos);
  EXPECT_NE(message_of({}, {}).find("width"), std::string::npos);
  StereoParameters parameters;
  parameters.window = 14;
  EXPECT_NE(message_of(small_camera(), parameters).find("window: must be odd"), std::string::npos);
  parameters = {};
  parameters.sigma_track = std::nan("");
  EXPECT_NE(message_of(small_camera(), parameters).find("sigma_track"), std::string::npos);
}

}  // namespace
}  // namespace maploop::stereo
