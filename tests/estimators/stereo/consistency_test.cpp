// These tests check the covariance against the errors of the motions without a reference: two
// odometries use disjoint halves of the features of the recorded drive.
#include <gtest/gtest.h>

#include "estimators/stereo/detect.h"
#include "estimators/stereo/motion_estimator.h"
#include "estimators/stereo/track.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/real_data.h"
#include "tools/odometry/consistency.h"

namespace maploop::stereo {
namespace {

using maploop::testing::drive_0013;
using odometry::JoinedMotion;

std::vector<Feature> features_of(const StereoFrame& frame, const StereoParameters& parameters) {
  std::vector<cv::Point2f> corners;
  CornerDetector(parameters).detect(frame.left, {}, &corners);
  std::vector<StereoObservation> matched;
  match_new_corners(frame, parameters, corners, &matched);
  std::vector<Feature> features;
  for (const StereoObservation& seen : matched)
    features.push_back({static_cast<std::int64_t>(features.size()), seen});
  return features;
}

TEST(Consistency, HalvesOfTheFeaturesDifferOverASecondByNoMoreThanTheirCovariancesSay) {
  MAPLOOP_REQUIRE_DRIVE();
  const StereoCalibration camera = maploop::sensors::KittiDrive(drive_0013()).calibration().stereo;
  const auto pairs = maploop::testing::read_pairs(maploop::sensors::KittiDrive(drive_0013()));
  StereoParameters parameters;
  parameters.features_per_bucket = 4;
  parameters.sigma_disparity_offset = 0.0;  // the offset is equal in both halves

  constexpr int pairs_a_second = 10;  // pairs
  StereoFrame before, now;
  std::array<JoinedMotion, 2> halves;
  double nees = 0.0;
  int seconds = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    now.left.build(pairs[k].left, parameters);
    now.right.build(pairs[k].right, parameters);
    if (k > 0) {
      std::vector<StereoTrack> tracks;
      track_features(camera, parameters, before, now, features_of(before, parameters), std::nullopt,
                     &tracks);
      for (std::size_t half = 0; half < 2; ++half) {
        std::vector<StereoTrack> mine;
        for (const StereoTrack& track : tracks)
          if (static_cast<std::size_t>(track.id % 2) == half) mine.push_back(track);
        const CameraMotion motion =
            estimate_motion(camera, parameters, mine, k, DisparityOffset(parameters));
        ASSERT_EQ(motion.status, OdometryStatus::ok) << "pair " << k;
        halves[half].append(motion.T_previous_current, motion.covariance);
      }
      if (k % pairs_a_second == 0) {
        const auto difference = odometry::pose_difference(halves[0].pose, halves[1].pose);
        const odometry::Matrix6 covariance = halves[0].covariance + halves[1].covariance;
        nees += difference.dot(covariance.ldlt().solve(difference)) / 6.0;
        ++seconds;
        halves = {};
      }
    }
    std::swap(before, now);
  }
  nees /= seconds;
  RecordProperty("nees", std::to_string(nees));
  // The value is multiplied by correlated_pairs = 5 for independent pairs. Errors shared by both
  // halves, such as those of the calibration, do not appear here.
  EXPECT_LT(nees, 0.6) << "over " << seconds << " s";
  EXPECT_GT(nees, 0.1) << "over " << seconds << " s";
}

}  // namespace
}  // namespace maploop::stereo
