// Tests the lenses against OpenCV's own functions, their derivatives against differences, and their
// inverse.
#include "sensors/camera/distortion.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <ostream>
#include <string>

#include "sensors/camera/camera_model.h"
#include "sensors/camera/rectification.h"

namespace maploop::sensors {
namespace {

constexpr Distortion brown{-0.28, 0.09, 0.001, -0.0007, -0.01};
constexpr Distortion rational{0.35, 0.12, 0.0005, -0.0003, 0.01, 0.68, 0.21, 0.03};
constexpr Distortion wide{
    .k1 = 0.0034, .k2 = 0.0007, .k3 = -0.0021, .k4 = 0.0002, .lens = Lens::equidistant};

std::vector<Eigen::Vector2d> rays(double most) {
  std::vector<Eigen::Vector2d> all{{0.0, 0.0}, {1e-8, 0.0}};
  for (const double x : {-1.0, -0.4, 0.1, 0.7})
    for (const double y : {-0.9, -0.2, 0.3, 1.0}) all.emplace_back(most * x, most * y);
  return all;
}

Eigen::Vector2d of_opencv(const Distortion& d, const Eigen::Vector2d& ray) {
  if (d.lens == Lens::equidistant) {
    std::vector<cv::Point2d> points{{ray.x(), ray.y()}}, bent;
    const cv::Mat identity = cv::Mat::eye(3, 3, CV_64F);
    cv::fisheye::distortPoints(points, bent, identity, cv::Vec4d(d.k1, d.k2, d.k3, d.k4));
    return {bent[0].x, bent[0].y};
  }
  const std::vector<cv::Point3d> points{{ray.x(), ray.y(), 1.0}};
  std::vector<cv::Point2d> bent;
  const cv::Mat zero = cv::Mat::zeros(3, 1, CV_64F);
  const std::vector<double> k{d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6};
  cv::projectPoints(points, zero, zero, cv::Mat::eye(3, 3, CV_64F), k, bent);
  return {bent[0].x, bent[0].y};
}

struct Case {
  const char* name;
  Distortion lens;
  double most;  // of x and y of the rays
};

// The name of a test must be the same in each process.
void PrintTo(const Case& lens, std::ostream* out) {
  *out << lens.name;
}

class Lenses : public ::testing::TestWithParam<Case> {};

TEST_P(Lenses, AgreeWithOpenCV) {
  for (const Eigen::Vector2d& ray : rays(GetParam().most)) {
    EXPECT_LT((apply(GetParam().lens, ray).point - of_opencv(GetParam().lens, ray)).norm(), 1e-12)
        << ray.transpose();
  }
}

TEST_P(Lenses, HaveTheDerivativesOfDifferences) {
  constexpr double step = 1e-6;
  for (const Eigen::Vector2d& ray : rays(GetParam().most)) {
    for (const int axis : {0, 1}) {
      const Eigen::Vector2d d = step * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d difference =
          (apply(GetParam().lens, ray + d).point - apply(GetParam().lens, ray - d).point) /
          (2.0 * step);
      EXPECT_LT((apply(GetParam().lens, ray).by_point.col(axis) - difference).norm(), 1e-8)
          << ray.transpose();
    }
  }
}

TEST_P(Lenses, AreReversedExactly) {
  const CameraModel camera{400.0, 410.0, 320.0, 240.0, GetParam().lens};
  for (const Eigen::Vector2d& ray : rays(GetParam().most)) {
    const auto pixel = project(camera, ray);
    ASSERT_TRUE(pixel) << ray.transpose();
    const auto back = ray_of(camera, *pixel);
    ASSERT_TRUE(back) << ray.transpose();
    EXPECT_LT((*back - ray).norm(), 1e-9) << ray.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lenses,
                         ::testing::Values(Case{"brown", brown, 0.6},
                                           Case{"rational", rational, 1.0},
                                           Case{"equidistant", wide, 4.0}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Lens, APolynomialThatTurnsBackIsNone) {
  EXPECT_TRUE(is_lens(brown, {0.6, 0.4}));
  EXPECT_FALSE(is_lens({.k1 = -0.5}, {1.0, 1.0}));
  EXPECT_FALSE(is_lens({.k4 = -0.5}, {1.2, 1.2})) << "Its denominator is zero at r^2 = 2.";
  EXPECT_FALSE(is_lens({.k1 = -0.5, .lens = Lens::equidistant}, {3.0, 0.0}));
}

// The field of two lenses of 170 deg is cut to what a plane picture can show.
TEST(Lens, TwoWideCamerasAreRectified) {
  const CameraModel camera{190.0, 190.0, 255.5, 255.5, wide};
  Eigen::Isometry3d T_right_left(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()));
  T_right_left.translation() = Eigen::Vector3d(-0.1, 0.001, 0.0);
  const StereoRig rig = rectify(camera, camera, T_right_left, 512, 512);
  EXPECT_EQ(problem_of(rig), std::nullopt);
  constexpr double widest = 2.214;  // rad, of a rectified picture: 127 deg
  EXPECT_NEAR(2.0 * std::atan(0.5 * rig.rectified.width / rig.rectified.fx), widest, 0.01);
}

}  // namespace
}  // namespace maploop::sensors
