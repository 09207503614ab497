#include "tools/evaluate/kitti_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace maploop::evaluation {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180.0;

Eigen::Isometry3d pose_at(double x, double z, double yaw) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  pose.translation() = Eigen::Vector3d(x, 0.0, z);
  return pose;
}

// Returns a straight drive along z in steps of `step` m.
Trajectory straight(int frames, double step) {
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) trajectory.push_back(pose_at(0.0, step * i, 0.0));
  return trajectory;
}

// Returns 1 m steps along bends to either side, up and down, so that the segments point in all
// directions.
Trajectory winding(int frames) {
  Trajectory trajectory{Eigen::Isometry3d::Identity()};
  for (int i = 1; i < frames; ++i) {
    Eigen::Isometry3d step(Eigen::AngleAxisd(0.05 * std::sin(0.1 * i), Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(0.02 * std::cos(0.07 * i), Eigen::Vector3d::UnitX()));
    step.translation().z() = 1.0;
    trajectory.push_back(trajectory.back() * step);
  }
  return trajectory;
}

TEST(KittiMetric, SegmentEndsAtTheFirstFramePastItsLength) {
  // With 2 m steps and 100 m, frame 50 is at exactly 100 m and not past it, so that a segment has
  // 102 m. An estimate that is 1 % too long has an error of 1.02 m, which is 1.02 % of the length.
  const Score result = score(straight(61, 2.0 * 1.01), straight(61, 2.0), 100.0);
  EXPECT_NEAR(result.segment.percent, 1.02, 1e-9);
  EXPECT_NEAR(result.segment.deg_per_m, 0.0, 1e-6);
  EXPECT_EQ(result.segment.segments, 10);  // first frames 0 to 9: frame 9 + 51 = 60 is the last
  EXPECT_NEAR(result.distance_m, 120.0, 1e-9);
  EXPECT_NEAR(result.end_point_m, 1.2, 1e-9);
  EXPECT_NEAR(result.end_point_percent, 1.0, 1e-9);
  EXPECT_EQ(result.frames, 61);
}

TEST(KittiMetric, TurnErrorIsInDegreesAMetre) {
  Trajectory estimate;  // does not move, turns 0.02 degrees in each frame
  for (int i = 0; i < 200; ++i)
    estimate.push_back(pose_at(0.0, 0.0, 0.02 * radians_per_degree * i));
  const Score result = score(estimate, straight(200, 1.0), 50.0);
  EXPECT_NEAR(result.segment.deg_per_m, 51 * 0.02 / 50.0, 1e-9);
  EXPECT_NEAR(result.segment.percent, 102.0, 1e-9);
}

TEST(KittiMetric, HalfTurnIsNotANumberNowhere) {
  Trajectory estimate = straight(80, 1.0);
  for (std::size_t i = 26; i < estimate.size(); ++i) {
    estimate[i].linear() = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()).matrix();
  }
  const Score result = score(estimate, straight(80, 1.0), 60.0);
  EXPECT_NEAR(result.segment.deg_per_m, 3.0, 1e-6);
}

TEST(KittiMetric, StartOfEitherTrajectoryDoesNotMatter) {
  Eigen::Isometry3d elsewhere(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()));
  elsewhere.translation() = Eigen::Vector3d(3e3, -40, 700);
  const Trajectory truth = winding(150);
  Trajectory estimate = truth;
  for (Eigen::Isometry3d& pose : estimate) pose = elsewhere * pose;
  const Score result = score(estimate, truth, 100.0);
  EXPECT_NEAR(result.end_point_m, 0.0, 1e-9);
  EXPECT_NEAR(result.segment.percent, 0.0, 1e-9);
}

TEST(KittiMetric, CommonRotationIsRemovedAndNothingElse) {
  const Eigen::Isometry3d mount(
      Eigen::AngleAxisd(0.7 * radians_per_degree, Eigen::Vector3d(1, 5, 2).normalized()));
  const Trajectory truth = winding(200);
  Trajectory estimate = truth;
  for (Eigen::Isometry3d& pose : estimate) pose = mount * pose * mount.inverse();
  EXPECT_GT(score(estimate, truth, 100.0).segment.percent, 0.5);
  EXPECT_NEAR(score(estimate, truth, 100.0, CommonRotation::remove).segment.percent, 0.0, 1e-9);
  EXPECT_TRUE(fit_common_rotation(estimate, truth).isApprox(mount.linear().transpose(), 1e-9));

  for (Eigen::Isometry3d& pose : estimate) pose.translation() *= 1.02;  // a scale error remains
  const double with_scale = score(estimate, truth, 100.0, CommonRotation::remove).segment.percent;
  for (Eigen::Isometry3d& pose : estimate) pose = mount.inverse() * pose * mount;
  EXPECT_NEAR(with_scale, score(estimate, truth, 100.0).segment.percent, 1e-6);
}

TEST(KittiMetric, MirroredTrajectoryIsNotRotatedAway) {
  const Trajectory truth = winding(200);
  Trajectory estimate = truth;  // descends where the truth climbs, and turns the other way
  for (Eigen::Isometry3d& pose : estimate) {
    const Eigen::Vector3d t = pose.translation();
    pose = pose_at(-t.x(), t.z(), 0.0);
    pose.translation().y() = -t.y();
  }
  EXPECT_NEAR(fit_common_rotation(estimate, truth).determinant(), 1.0, 1e-9);
}

TEST(KittiMetric, DriveShorterThanTheLengthHasNoSegment) {
  const Score result = score(straight(11, 1.01), straight(11, 1.0), 100.0, CommonRotation::remove);
  EXPECT_EQ(result.segment.segments, 0);
  EXPECT_TRUE(std::isnan(result.segment.percent));
  EXPECT_TRUE(std::isnan(result.segment.deg_per_m));
  EXPECT_NEAR(result.end_point_m, 0.1, 1e-9);
}

TEST(KittiMetric, StandingVehicleHasNoPercentage) {
  const Score result = score(straight(10, 0.0), straight(10, 0.0), 100.0);
  EXPECT_EQ(result.distance_m, 0.0);
  EXPECT_TRUE(std::isnan(result.end_point_percent));
}

TEST(KittiMetric, LongerTrajectoryIsCutAndTheCoverageSaid) {
  const Score result = score(straight(40, 1.0), straight(60, 1.0), 10.0);
  EXPECT_EQ(result.frames, 40);
  EXPECT_NEAR(result.distance_m, 39.0, 1e-9);
  EXPECT_NEAR(result.end_point_m, 0.0, 1e-9);
}

TEST(KittiMetric, BenchmarkFigureIsTheMeanOverAllSegmentsOfAllLengths) {
  // 1001 m in 1 m steps have 101 start frames; those up to 1001 - (L + 1) have a segment.
  const Trajectory truth = straight(1002, 1.0);
  const SegmentError error = kitti_odometry_error(straight(1002, 1.02), truth);
  double sum = 0.0;
  int segments = 0;
  for (int length = 100; length <= 800; length += 100) {
    for (int first = 0; first + length + 1 <= 1001; first += 10) {
      sum += 100.0 * 0.02 * (length + 1) / length;
      ++segments;
    }
  }
  EXPECT_EQ(error.segments, segments);
  EXPECT_NEAR(error.percent, sum / segments, 1e-9);
}

TEST(KittiMetric, BadInputIsRefused) {
  const Trajectory ten = straight(10, 1.0);
  EXPECT_THROW(score({}, ten, 100.0), std::invalid_argument);
  EXPECT_THROW(score(ten, straight(1, 1.0), 100.0), std::invalid_argument);
  EXPECT_THROW(score(ten, ten, 0.0), std::invalid_argument);
  EXPECT_THROW(score(ten, ten, std::nan("")), std::invalid_argument);
  EXPECT_THROW(kitti_odometry_error({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace maploop::evaluation
