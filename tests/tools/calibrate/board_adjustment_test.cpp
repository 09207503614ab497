// Tests the adjustment alone, on corners computed from the truth.
#include "tools/calibrate/board_adjustment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "tests/tools/calibrate/rendered_views.h"
#include "tests/tools/refusal.h"

namespace maploop::calibrate {
namespace {

using maploop::testing::refusal;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Adjusting : public ::testing::Test {
 protected:
  std::vector<View> views(std::size_t count, double sigma, std::uint32_t seed) const {
    std::vector<View> all;
    std::uint32_t number = 1000 * seed;
    for (const auto& pose :
         testing::board_poses(renderer, rig, rendered(board), count, 0.35, 0.6, seed))
      all.push_back(ideal_view(renderer, board, pose, sigma, number++));
    return all;
  }

  testing::RenderedRig rig = testing::example_rig();
  testing::BoardRenderer renderer{rig};
};

TEST(Projection, DerivativesAreThoseOfDifferences) {
  const testing::RenderedRig rig = testing::example_rig();
  const sensors::CameraModel camera = as_model(rig.left);
  const Eigen::Vector3d point(0.3, -0.2, 0.7);
  const Projection at = project_with_derivatives(camera, point);
  constexpr double step = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d slope = (project_with_derivatives(camera, point + d).pixel -
                                   project_with_derivatives(camera, point - d).pixel) /
                                  (2.0 * step);
    EXPECT_LT((slope - at.by_point.col(axis)).norm(), 1e-5) << "axis " << axis;
  }
  for (int i = 0; i < camera_parameter_count; ++i) {
    const auto changed = [&](double by) {
      sensors::CameraModel c = camera;
      *numbers_of(c).at(static_cast<std::size_t>(i)) += by;
      return project_with_derivatives(c, point).pixel;
    };
    const Eigen::Vector2d slope = (changed(step) - changed(-step)) / (2.0 * step);
    EXPECT_LT((slope - at.by_camera.col(i)).norm(), 1e-5) << "parameter " << i;
  }
  EXPECT_LT((at.pixel - testing::BoardRenderer(rig).project(true, point)).norm(), 1e-9)
      << "OpenCV sees it elsewhere";
}

TEST_F(Adjusting, WithoutNoiseTheTruthIsFound) {
  const StereoResult result = calibrate(board, views(12, 0.0, 1), rig.width, rig.height);
  const CommonVector error = error_of(result.rig, rig);
  EXPECT_LT(error.head<4>().norm(), 1e-3) << error.transpose();
  EXPECT_LT(error.tail<6>().norm(), 1e-7) << error.transpose();
  EXPECT_LT(result.adjustment.rms, 1e-6);
  EXPECT_TRUE(result.bad.empty());
}

// The mean of (error / sigma)^2 is 1 if the standard deviations are correct: over 24 parameters and
// 12 sets of views its own standard deviation is below 0.2, including correlations.
TEST_F(Adjusting, StandardDeviationsAgreeWithTheErrors) {
  constexpr int sets = 12;
  double sum = 0.0;
  for (int set = 0; set < sets; ++set) {
    const StereoResult result = calibrate(
        board, views(12, 0.1, static_cast<std::uint32_t>(100 + set)), rig.width, rig.height);
    ASSERT_TRUE(result.adjustment.converged);
    EXPECT_NEAR(result.adjustment.rms, 0.1 * std::sqrt(2.0), 0.01);
    const CommonVector error = error_of(result.rig, rig);
    sum += error.cwiseQuotient(result.adjustment.sigma).squaredNorm() / common_parameter_count;
  }
  std::cout << "mean square of error / sigma: " << sum / sets << '\n';
  EXPECT_GT(sum / sets, 0.6);
  EXPECT_LT(sum / sets, 1.6);
}

TEST_F(Adjusting, AViewWhoseRightImageWasTakenLaterIsLeftOutByName) {
  auto all = views(12, 0.05, 3);
  all[4].right = all[7].right;
  all[4].name = "late.png";
  for (Eigen::Vector2d& c : all[9].left) c += Eigen::Vector2d(3.0, 0.0);
  all[9].name = "shifted.png";
  const StereoResult result = calibrate(board, all, rig.width, rig.height);
  std::vector<std::string> names;
  for (const BadView& bad : result.bad) names.push_back(bad.name);
  EXPECT_EQ(names, (std::vector<std::string>{"late.png", "shifted.png"}));
  EXPECT_LT(std::abs(error_of(result.rig, rig)[0]), 1.0);
  EXPECT_LT(result.adjustment.rms, 0.1);
}

TEST_F(Adjusting, TooFewViewsAreRefusedWithTheirNumber) {
  EXPECT_THAT(refusal([&] { calibrate(board, views(5, 0.0, 1), rig.width, rig.height); }),
              AllOf(HasSubstr("too few views"), HasSubstr("5 pairs")));
}

TEST_F(Adjusting, BoardsThatAreAllParallelAreRefused) {
  for (const double tilt : {0.0, 0.5}) {
    std::vector<View> parallel;
    for (int i = 0; i < 10; ++i) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()).matrix();
      pose.translation() << -0.25 + 0.03 * i, -0.15 + 0.02 * i, 0.5 + 0.03 * i;
      parallel.push_back(ideal_view(renderer, board, pose, 0.05, static_cast<std::uint32_t>(i)));
    }
    EXPECT_THAT(refusal([&] { calibrate(board, parallel, rig.width, rig.height); }),
                HasSubstr("nearly parallel"))
        << tilt;
  }
}

TEST_F(Adjusting, SwappedCamerasAreNamed) {
  auto swapped = views(8, 0.05, 5);
  for (View& view : swapped) std::swap(view.left, view.right);
  EXPECT_THAT(refusal([&] { calibrate(board, swapped, rig.width, rig.height); }),
              HasSubstr("swapped"));
}

TEST_F(Adjusting, RectificationBringsCornersOntoOneRowAndEveryPixelIsSeen) {
  const StereoResult result = calibrate(board, views(12, 0.0, 1), rig.width, rig.height);
  EXPECT_LT(result.row_error, 1e-5);
  EXPECT_EQ(problem_of(result.rig), std::nullopt);
  const StereoCalibration& r = result.rig.rectified;
  for (const bool left : {true, false}) {
    const sensors::CameraModel& camera = left ? result.rig.left : result.rig.right;
    const Eigen::Matrix3d& R = left ? result.rig.R_rect_left : result.rig.R_rect_right;
    for (int i = 0; i <= 20; ++i)
      for (int k = 0; k <= 20; ++k) {
        if (i % 20 != 0 && k % 20 != 0) continue;  // the border
        const Eigen::Vector3d ray =
            R.transpose() * Eigen::Vector3d(((r.width - 1) * k / 20.0 - r.cx) / r.fx,
                                            ((r.height - 1) * i / 20.0 - r.cy) / r.fy, 1.0);
        const auto pixel = sensors::project(camera, ray.hnormalized());
        ASSERT_TRUE(pixel);
        EXPECT_GT(pixel->minCoeff(), -0.1);
        EXPECT_LT(pixel->x(), rig.width - 0.9);
        EXPECT_LT(pixel->y(), rig.height - 0.9);
      }
  }
}

// x_right^T E x_left = 0, on points that were not used for the estimate.
TEST_F(Adjusting, EssentialAndFundamentalMatrixHoldForTrueRays) {
  const StereoResult result = calibrate(board, views(12, 0.0, 1), rig.width, rig.height);
  const Eigen::Matrix3d E = essential_matrix(result.rig), F = fundamental_matrix(result.rig);
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(1.0, 0.5, 3.0), Eigen::Vector3d(-2.0, 0.1, 9.0)}) {
    const Eigen::Vector3d q = rig.T_right_left * p;
    const Eigen::Vector3d left = p / p.z(), right = q / q.z();
    EXPECT_NEAR(right.dot(E * left), 0.0, 1e-7);
    const Eigen::Vector3d u(rig.left.fx * left.x() + rig.left.cx,
                            rig.left.fy * left.y() + rig.left.cy, 1.0);
    const Eigen::Vector3d v(rig.right.fx * right.x() + rig.right.cx,
                            rig.right.fy * right.y() + rig.right.cy, 1.0);
    EXPECT_NEAR(v.dot(F * u), 0.0, 1e-5);
  }
}

}  // namespace
}  // namespace maploop::calibrate
