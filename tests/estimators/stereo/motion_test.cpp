#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "estimators/stereo/disparity_offset.h"
#include "estimators/stereo/motion_estimator.h"
#include "estimators/stereo/plausibility.h"
#include "estimators/stereo/ransac.h"
#include "estimators/stereo/refine.h"
#include "tests/estimators/stereo/synthetic_scene.h"

namespace maploop::stereo {
namespace {

using maploop::testing::all_of;
using maploop::testing::driving_motion;
using maploop::testing::pose_error;
using maploop::testing::small_camera;
using maploop::testing::synthetic_tracks;

// Returns the noise that the adjustment expects.
maploop::testing::ImageNoise modelled_noise(const StereoParameters& p) {
  return {p.sigma_track, p.sigma_disparity, p.sigma_match, 0.0};
}

// Moves the first `count` tracks like one other rigid body.
void replace_by_moving_object(std::vector<StereoTrack>* tracks, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    (*tracks)[i].current.u_left += 15.0;
    (*tracks)[i].current.u_right += 15.0;
  }
}

TEST(Refine, RecoversAKnownMotionExactlyFromPerfectTracks) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 60, {}, 1);
  const Refinement refined =
      refine_motion(small_camera(), {}, tracks, all_of(tracks), Eigen::Isometry3d::Identity(), 0.0);
  ASSERT_TRUE(refined.ok);
  EXPECT_LT(pose_error(refined.T_previous_current, driving_motion()).norm(), 1e-7);
  EXPECT_EQ(refined.inliers.size(), tracks.size());
}

TEST(Refine, CovarianceAgreesWithTheErrorsOverManyNoisyScenes) {
  StereoParameters parameters;
  parameters.correlated_pairs = 1.0;  // the errors of these scenes are independent
  double nees = 0.0, variance_factor = 0.0;
  constexpr int scene_count = 300;
  for (unsigned seed = 0; seed < scene_count; ++seed) {
    const auto tracks =
        synthetic_tracks(small_camera(), driving_motion(), 100, modelled_noise(parameters), seed);
    const Refinement refined =
        refine_motion(small_camera(), parameters, tracks, all_of(tracks), driving_motion(), 0.0);
    ASSERT_TRUE(refined.ok);
    const Eigen::Matrix<double, 6, 1> error =
        pose_error(refined.T_previous_current, driving_motion());
    nees += error.dot(refined.covariance.ldlt().solve(error)) / 6.0 / scene_count;
    variance_factor += refined.variance_factor / scene_count;
  }
  // With 1800 degrees of freedom, 0.87 to 1.13 is four standard deviations of chi-square.
  EXPECT_GT(nees, 0.87);
  EXPECT_LT(nees, 1.2);  // Huber's weights add a little
  EXPECT_NEAR(variance_factor, 1.0, 0.1);
}

TEST(Refine, CovarianceGrowsWithTheRealResiduals) {
  const StereoParameters parameters;
  maploop::testing::ImageNoise noise = modelled_noise(parameters);
  const auto calm = synthetic_tracks(small_camera(), driving_motion(), 100, noise, 5);
  noise = {2.0 * noise.track, 2.0 * noise.disparity, 2.0 * noise.match, 0.0};
  const auto rough = synthetic_tracks(small_camera(), driving_motion(), 100, noise, 5);
  const auto sigma = [&](const std::vector<StereoTrack>& tracks) {
    return std::sqrt(
        refine_motion(small_camera(), parameters, tracks, all_of(tracks), driving_motion(), 0.0)
            .covariance(2, 2));
  };
  EXPECT_GT(sigma(rough) / sigma(calm), 1.4);
}

TEST(Refine, SeesAnOffsetOfAllDisparitiesWithoutKnowingTheMotion) {
  StereoParameters parameters;
  parameters.correlated_pairs = 1.0;
  double sum = 0.0, weights = 0.0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    auto noise = modelled_noise(parameters);
    noise.offset = 0.25;
    const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 150, noise, seed);
    const Refinement refined =
        refine_motion(small_camera(), parameters, tracks, all_of(tracks), driving_motion(), 0.3);
    ASSERT_TRUE(refined.ok);
    const double weight = 1.0 / (refined.offset_sigma * refined.offset_sigma);
    sum += weight * refined.offset;
    weights += weight;
  }
  EXPECT_NEAR(sum / weights, 0.25, 4.0 / std::sqrt(weights) + 0.02);
}

TEST(Refine, CovarianceCarriesAnOffsetThatIsNotKnown) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 100, {}, 3);
  const auto forward_sigma = [&](double offset_sigma) {
    return std::sqrt(
        refine_motion(small_camera(), {}, tracks, all_of(tracks), driving_motion(), offset_sigma)
            .covariance(2, 2));
  };
  EXPECT_GT(forward_sigma(0.3), forward_sigma(0.0) + 0.003);
}

TEST(Refine, TooFewTracksAndTracksBehindTheCameraAreNoSolution) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 60, {}, 1);
  EXPECT_FALSE(refine_motion(small_camera(), {}, tracks, std::vector<int>{0, 1},
                             Eigen::Isometry3d::Identity(), 0.0)
                   .ok);
  Eigen::Isometry3d beyond = Eigen::Isometry3d::Identity();
  beyond.translation().z() = 1000.0;
  EXPECT_FALSE(refine_motion(small_camera(), {}, tracks, all_of(tracks), beyond, 0.0).ok);
}

TEST(Ransac, FindsTheMotionOfTheMajority) {
  auto tracks = synthetic_tracks(small_camera(), driving_motion(), 100, {0.2, 0.2, 0.0, 0.0}, 2);
  replace_by_moving_object(&tracks, 40);
  const Consensus consensus = ransac_motion(small_camera(), {}, tracks, 11, std::nullopt);
  EXPECT_LT(pose_error(consensus.T_current_previous.inverse(), driving_motion()).norm(), 0.1);
  int from_object = 0;
  for (const int i : consensus.inliers) from_object += i < 40 ? 1 : 0;
  EXPECT_EQ(from_object, 0);
  EXPECT_GE(consensus.inliers.size(), 55u);
}

TEST(Ransac, NeedsFewHypothesesWhereAllAgreeAndStopsAtTheCapWhereNoneDo) {
  const auto good = synthetic_tracks(small_camera(), driving_motion(), 100, {}, 2);
  EXPECT_LE(ransac_motion(small_camera(), {}, good, 1, std::nullopt).hypotheses, 2);
  auto scattered = good;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 600.0);
  for (StereoTrack& track : scattered) {
    track.current.u_left = u(random);
    track.current.u_right = track.current.u_left - 10.0;
  }
  const StereoParameters parameters;
  const Consensus consensus = ransac_motion(small_camera(), parameters, scattered, 1, std::nullopt);
  EXPECT_EQ(consensus.hypotheses, parameters.ransac_max_hypotheses);
  EXPECT_LT(consensus.inliers.size(), 20u);
}

TEST(Ransac, SameSeedSameBitsOtherSeedOtherSamples) {
  auto tracks = synthetic_tracks(small_camera(), driving_motion(), 100, {0.3, 0.3, 0.3, 0.0}, 2);
  const auto run = [&](std::uint64_t seed) {
    return ransac_motion(small_camera(), {}, tracks, seed, std::nullopt)
        .T_current_previous.matrix();
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

TEST(Ransac, FewerThanThreeTracksHaveNoConsensus) {
  const auto tracks = synthetic_tracks(small_camera(), driving_motion(), 2, {}, 2);
  EXPECT_TRUE(ransac_motion(small_camera(), {}, tracks, 1, std::nullopt).inliers.empty());
}

TEST(Refine, InertiaDecidesWhereTheTracksLeaveTheMotionOpen) {
  const StereoCalibration camera = small_camera();
  const StereoParameters parameters;
  // The scene has six far points close together, where a turn about the vertical looks like a step
  // sideways.
  std::vector<StereoTrack> tracks;
  for (int i = 0; i < 6; ++i) {
    const ImagePoint before(300.0 + 4.0 * i, 100.0 + 5.0 * (i % 3), 4.0);
    const ImagePoint after =
        project(camera, driving_motion().inverse() * triangulate(camera, before));
    const double off = i % 2 == 0 ? 0.3 : -0.3;  // px, the tracker's errors
    tracks.push_back({i,
                      {before.x(), before.y(), before.x() - before.z(), before.y()},
                      {after.x() + off, after.y(), after.x() - after.z(), after.y()}});
  }
  const auto all = all_of(tracks);
  MotionPrior prior{driving_motion(), {}};
  prior.sigma << Eigen::Vector3d::Constant(0.03), Eigen::Vector3d::Constant(0.01);
  const Refinement without = refine_motion(camera, parameters, tracks, all, driving_motion(), 0.0);
  const Refinement with =
      refine_motion(camera, parameters, tracks, all, driving_motion(), 0.0, prior);
  ASSERT_TRUE(with.ok);
  EXPECT_GT(pose_error(without.T_previous_current, driving_motion()).norm(), 0.1);
  EXPECT_LT(pose_error(with.T_previous_current, driving_motion()).norm(), 0.06);
  EXPECT_LT(with.covariance(0, 0), 0.03 * 0.03 * 1.01) << "no worse than expected beforehand";
}

TEST(MotionEstimator, ReportsIndicesOfTheTracksThatAgree) {
  auto tracks = synthetic_tracks(small_camera(), driving_motion(), 100, {}, 4);
  tracks[0].current.u_left = std::numeric_limits<double>::quiet_NaN();
  tracks[1].previous.u_right = tracks[1].previous.u_left + 3.0;  // behind the cameras
  tracks[2].current.v_right += 5.0;                              // another row
  tracks[3].current.u_left += 30.0;                              // usable, but on a moving object
  const CameraMotion motion =
      estimate_motion(small_camera(), {}, tracks, 1, DisparityOffset(StereoParameters{}));
  ASSERT_EQ(motion.status, OdometryStatus::ok);
  EXPECT_EQ(motion.tracked, 97);
  ASSERT_EQ(motion.inliers.size(), 96u);
  EXPECT_EQ(motion.inliers.front(), 4);
  EXPECT_EQ(motion.inliers.back(), 99);
  EXPECT_LT(pose_error(motion.T_previous_current, driving_motion()).norm(), 1e-6);
}

TEST(MotionEstimator, RefusesFewTracksAndTracksWithoutConsensus) {
  const DisparityOffset offset{StereoParameters{}};
  EXPECT_EQ(estimate_motion(small_camera(), {}, {}, 1, offset).status,
            OdometryStatus::too_few_features);
  const auto few = synthetic_tracks(small_camera(), driving_motion(), 24, {}, 4);
  EXPECT_EQ(estimate_motion(small_camera(), {}, few, 1, offset).status,
            OdometryStatus::too_few_features);
  auto scattered = synthetic_tracks(small_camera(), driving_motion(), 100, {}, 4);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.0, 600.0);
  for (StereoTrack& track : scattered) {
    track.current.u_left = u(random);
    track.current.u_right = track.current.u_left - 10.0;
  }
  EXPECT_EQ(estimate_motion(small_camera(), {}, scattered, 1, offset).status,
            OdometryStatus::too_few_inliers);
}

TEST(MotionEstimator, BodyMotionAndCovarianceAgreeWithMovingTheCameraNumerically) {
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  T_body_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_body_cam.translation() = Eigen::Vector3d(1.1, -0.3, 0.7);
  CameraMotion motion;
  motion.T_previous_current = driving_motion();
  Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Random() * 0.01;
  motion.covariance = root * root.transpose();
  RelativeMotion body;
  to_body(T_body_cam, motion, &body);
  EXPECT_LT(
      pose_error(body.T_from_to(), T_body_cam * driving_motion() * T_body_cam.inverse()).norm(),
      1e-12);

  Eigen::Matrix<double, 6, 6> numerical;
  for (int i = 0; i < 6; ++i) {
    const double step = 1e-6;
    Eigen::Isometry3d moved = driving_motion();
    if (i < 3)
      moved.translation()[i] += step;
    else
      moved.linear() =
          Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(i - 3)).toRotationMatrix() * moved.linear();
    numerical.col(i) =
        pose_error(T_body_cam * moved * T_body_cam.inverse(), body.T_from_to()) / step;
  }
  const Eigen::Matrix<double, 6, 6> expected =
      numerical * motion.covariance * numerical.transpose();
  EXPECT_LT((body.covariance - expected).norm(), 1e-5 * expected.norm());
}

TEST(DisparityOffset, ConvergesOnConsistentPairsAndLeavesWeakOnesOut) {
  const StereoParameters parameters;
  DisparityOffset offset(parameters);
  for (int i = 0; i < 100; ++i) {
    offset.predict(0.1);
    offset.update(0.25 - offset.value(), 0.1, 150);
  }
  EXPECT_NEAR(offset.value(), 0.25, 0.01);
  EXPECT_LT(offset.sigma(), 0.02);

  const DisparityOffset before = offset;
  offset.update(0.05, 2.0 * parameters.max_offset_sigma, 150);   // hardly observable
  offset.update(0.05, 0.05, parameters.min_offset_inliers - 1);  // too few features
  offset.update(2.0, 0.1, 150);                                  // contradicts the present estimate
  offset.update(std::numeric_limits<double>::quiet_NaN(), 0.1, 150);
  EXPECT_EQ(offset.value(), before.value());
  EXPECT_EQ(offset.sigma(), before.sigma());
}

TEST(DisparityOffset, StaysZeroWhereTheRectificationIsTakenAsPerfect) {
  StereoParameters parameters;
  parameters.sigma_disparity_offset = 0.0;
  DisparityOffset offset(parameters);
  offset.predict(10.0);
  offset.update(0.2, 0.05, 500);
  EXPECT_EQ(offset.value(), 0.0);
  EXPECT_EQ(offset.sigma(), 0.0);
}

TEST(Plausibility, JudgesSpeedYawRateAndAccelerationOfTheBody) {
  const StereoParameters parameters;
  RelativeMotion motion;
  motion.translation = {1.0, 0.0, 0.0};
  EXPECT_TRUE(plausible(motion, 0.1, std::nullopt, parameters));
  EXPECT_TRUE(
      plausible(motion, 0.1, LastVelocity{{9.5, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.1}, parameters));
  EXPECT_FALSE(
      plausible(motion, 0.1, LastVelocity{{8.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.1}, parameters))
      << "20 m/s^2";
  EXPECT_FALSE(plausible(motion, 0.01, std::nullopt, parameters)) << "100 m/s";
  motion.rotation = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(plausible(motion, 0.1, std::nullopt, parameters)) << "2 rad/s";
  motion.rotation = Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(plausible(motion, 0.1, std::nullopt, parameters));
  EXPECT_TRUE(
      plausible(motion, 0.1, LastVelocity{{10.0, 0.0, 0.0}, {0.0, 0.0, -0.9}, 0.1}, parameters));
  EXPECT_FALSE(
      plausible(motion, 0.1, LastVelocity{{10.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.1}, parameters))
      << "10 rad/s^2";
  EXPECT_TRUE(
      plausible(motion, 0.1, LastVelocity{{10.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.5}, parameters))
      << "known long ago";
  motion.covariance.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * 0.04;
  EXPECT_TRUE(
      plausible(motion, 0.1, LastVelocity{{8.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.1}, parameters))
      << "within three standard deviations";
}

}  // namespace
}  // namespace maploop::stereo
