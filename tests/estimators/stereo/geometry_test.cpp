#include <gtest/gtest.h>

#include "estimators/stereo/p3p.h"
#include "estimators/stereo/residual.h"
#include "tests/estimators/stereo/synthetic_scene.h"

namespace maploop::stereo {
namespace {

using maploop::testing::driving_motion;
using maploop::testing::small_camera;

TEST(Triangulate, ProjectsBackToTheSamePixel) {
  StereoCalibration camera = small_camera();
  camera.fy = 410.0;
  const ImagePoint image(17.5, 200.25, 12.0);
  EXPECT_LT((project(camera, triangulate(camera, image)) - image).norm(), 1e-10);
  EXPECT_DOUBLE_EQ(triangulate(camera, image).z(), camera.fx * camera.baseline / 12.0);
}

TEST(Triangulate, DepthSigmaIsTheChangeOfDepthForThatDisparity) {
  const StereoCalibration camera = small_camera();
  const double d = 10.0, sigma = 0.01;
  const double nearer = triangulate(camera, {0.0, 0.0, d + sigma}).z();
  const double farther = triangulate(camera, {0.0, 0.0, d - sigma}).z();
  const double depth = triangulate(camera, {0.0, 0.0, d}).z();
  EXPECT_NEAR(depth_sigma(camera, depth, sigma), 0.5 * (farther - nearer), 1e-5);
}

TEST(Prediction, JacobiansAgreeWithNumericalDerivatives) {
  StereoCalibration camera = small_camera();
  camera.fy = 410.0;
  const Eigen::Isometry3d pose = driving_motion();
  const double u = 100.0, v = 180.0, d = 15.0, step = 1e-6;
  const Prediction at = predict(camera, pose, u, v, d);
  ASSERT_TRUE(at.in_front);
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> delta = Eigen::Matrix<double, 6, 1>::Zero();
    delta[i] = step;
    const Eigen::Vector3d numerical = (predict(camera, perturbed(pose, delta), u, v, d).image -
                                       predict(camera, perturbed(pose, -delta), u, v, d).image) /
                                      (2.0 * step);
    EXPECT_LT((numerical - at.by_pose.col(i)).norm(), 1e-5) << "perturbation " << i;
  }
  const Eigen::Vector3d numerical =
      (predict(camera, pose, u, v, d + step).image - predict(camera, pose, u, v, d - step).image) /
      (2.0 * step);
  EXPECT_LT((numerical - at.by_disparity).norm(), 1e-5);
}

TEST(Prediction, SaysWhenThePointIsBehindTheCamera) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 20.0;
  EXPECT_FALSE(predict(small_camera(), pose, 320.0, 120.0, 20.0).in_front);  // 10 m ahead before
}

TEST(Quartic, FindsFourKnownRoots) {
  // The polynomial is (x - 1)(x + 2)(x - 3)(x - 0.5).
  const QuarticRoots roots = solve_quartic({1.0, -2.5, -4.0, 8.5, -3.0});
  ASSERT_EQ(roots.count, 4);
  std::array<double, 4> sorted = roots.value;
  std::sort(sorted.begin(), sorted.end());
  const std::array<double, 4> expected = {-2.0, 0.5, 1.0, 3.0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(sorted[i], expected[i], 1e-12);
}

TEST(Quartic, BiquadraticTwoRootsAndNone) {
  const QuarticRoots four = solve_quartic({1.0, 0.0, -5.0, 0.0, 4.0});  // x^2 is 1 or 4
  EXPECT_EQ(four.count, 4);
  EXPECT_EQ(solve_quartic({1.0, 0.0, 0.0, 0.0, -16.0}).count, 2);
  EXPECT_EQ(solve_quartic({1.0, 0.0, 5.0, 0.0, 4.0}).count, 0);
  EXPECT_EQ(solve_quartic({0.0, 1.0, 0.0, 0.0, 0.0}).count, 0) << "not a quartic";
  EXPECT_EQ(solve_quartic({NAN, 1.0, 0.0, 0.0, 0.0}).count, 0);
}

TEST(P3p, OneSolutionIsTheTruePoseInEveryOfManyScenes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> lateral(-8.0, 8.0), depth(4.0, 40.0), angle(-0.5, 0.5);
  int solved = 0;
  for (int scene = 0; scene < 1000; ++scene) {
    Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
    T_camera_world.linear() = (Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix();
    T_camera_world.translation() = Eigen::Vector3d(lateral(random), 1.0, lateral(random));
    std::array<Eigen::Vector3d, 3> points, bearings;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d p_camera(lateral(random), lateral(random), depth(random));
      points[i] = T_camera_world.inverse() * p_camera;
      bearings[i] = p_camera.normalized();
    }
    const P3pSolutions solutions = solve_p3p(points, bearings);
    double nearest = 1e9;
    for (int i = 0; i < solutions.count; ++i) {
      const auto& pose = solutions.T_camera_world[static_cast<std::size_t>(i)];
      EXPECT_LT((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
                1e-9);
      nearest = std::min(nearest, (pose.matrix() - T_camera_world.matrix()).norm());
    }
    if (nearest < 1e-4) ++solved;
  }
  EXPECT_GE(solved, 995);  // the others are within rounding of a double root
}

TEST(P3p, PointsOnALineHaveNoSolution) {
  const std::array<Eigen::Vector3d, 3> points = {
      Eigen::Vector3d(0, 0, 10), Eigen::Vector3d(1, 0, 10), Eigen::Vector3d(2, 0, 10)};
  std::array<Eigen::Vector3d, 3> bearings;
  for (std::size_t i = 0; i < 3; ++i) bearings[i] = points[i].normalized();
  EXPECT_EQ(solve_p3p(points, bearings).count, 0);
}

}  // namespace
}  // namespace maploop::stereo
