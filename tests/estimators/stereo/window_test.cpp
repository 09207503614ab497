// These tests compare the windowed bundle adjustment with numerical derivatives, known scenes and
// Ceres.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <random>

#include "estimators/stereo/bundle_adjustment.h"
#include "estimators/stereo/residual.h"
#include "estimators/stereo/velocity_change.h"
#include "tests/estimators/stereo/synthetic_scene.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/drawn.h"

namespace maploop::stereo {
namespace {

using maploop::testing::driving_motion;
using maploop::testing::pose_error;
using maploop::testing::small_camera;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double frame_period = 0.1;  // s

Time at(int frame) {
  return Time(from_seconds(100.0 + frame_period * frame));
}

Eigen::Isometry3d true_pose(int frame) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < frame; ++i) pose = pose * driving_motion();
  return pose;
}

StereoParameters with_window() {
  StereoParameters parameters;
  parameters.window_frames = 6;
  return parameters;
}

// The scene is a window of `frames` poses with errors of centimetres and `count` points that all
// poses see, with `noise` px on each measured u, v and disparity.
struct Scene {
  StereoCalibration camera = small_camera();
  StereoParameters parameters = with_window();
  Window window{parameters};

  Scene(int frames, int count, double noise, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> x(-10.0, 10.0), y(-3.0, 3.0), z(12.0, 50.0);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < count; ++i) {
      const double depth = z(random), down = y(random);
      points.emplace_back(x(random), down, depth);
    }
    const auto draw = [&] { return normal(random); };
    std::vector<std::vector<StereoObservation>> seen;
    for (int k = 0; k < frames; ++k) {
      auto& frame = seen.emplace_back();
      for (const Eigen::Vector3d& p : points) {
        const ImagePoint image = project(camera, true_pose(k).inverse() * p) +
                                 noise * maploop::testing::drawn<ImagePoint>(draw);
        frame.push_back({image.x(), image.y(), image.x() - image.z(), image.y()});
      }
    }
    window.poses.push_back({at(0), Eigen::Isometry3d::Identity()});
    std::vector<int> all(points.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    for (int k = 1; k < frames; ++k) {
      std::vector<StereoTrack> tracks;
      for (std::size_t i = 0; i < points.size(); ++i) {
        tracks.push_back({static_cast<std::int64_t>(i), seen[static_cast<std::size_t>(k - 1)][i],
                          seen[static_cast<std::size_t>(k)][i]});
      }
      Eigen::Isometry3d rough = true_pose(k);
      rough.translation() += 0.05 * maploop::testing::drawn<Eigen::Vector3d>(draw);
      window.add(camera, at(k), rough, tracks, all, 0.0);
    }
  }
};

TEST(VelocityChange, JacobiansAgreeWithNumericalDerivatives) {
  std::array<Eigen::Isometry3d, 3> poses{true_pose(1), true_pose(2), true_pose(3)};
  poses[1].rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()));
  poses[2].translation() += Eigen::Vector3d(0.1, -0.05, 0.2);
  const std::array<double, 2> seconds{0.1, 0.13};
  const VelocityChange change = velocity_change(poses, seconds);
  constexpr double difference_step = 1e-6;
  for (std::size_t pose = 0; pose < 3; ++pose) {
    for (int i = 0; i < 6; ++i) {
      auto moved = [&](double by) {
        auto p = poses;
        p[pose] = perturbed(p[pose], by * Vector6::Unit(i));
        return velocity_change(p, seconds).value;
      };
      const Vector6 numerical =
          (moved(difference_step) - moved(-difference_step)) / (2.0 * difference_step);
      EXPECT_LT((change.by_pose[pose].col(i) - numerical).norm(), 1e-5) << pose << ", " << i;
    }
  }
}

TEST(View, JacobiansAgreeWithNumericalDerivatives) {
  const StereoCalibration camera = small_camera();
  const Eigen::Vector3d point(3.0, -1.0, 14.0);
  const View view = view_point(camera, true_pose(3), point);
  ASSERT_TRUE(view.in_front);
  constexpr double difference_step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const auto image = [&](double by) {
      return view_point(camera, perturbed(true_pose(3), by * Vector6::Unit(i)), point).image;
    };
    EXPECT_LT((view.by_pose.col(i) -
               (image(difference_step) - image(-difference_step)) / (2.0 * difference_step))
                  .norm(),
              1e-4);
  }
  for (int i = 0; i < 3; ++i) {
    const auto image = [&](double by) {
      return view_point(camera, true_pose(3), point + by * Eigen::Vector3d::Unit(i)).image;
    };
    EXPECT_LT((view.by_point.col(i) -
               (image(difference_step) - image(-difference_step)) / (2.0 * difference_step))
                  .norm(),
              1e-4);
  }
}

TEST(BundleAdjustment, FindsThePosesOfAPerfectSceneExactly) {
  Scene scene(6, 60, 0.0);
  scene.parameters.window_iterations = 20;
  ASSERT_TRUE(BundleAdjustment(scene.camera, scene.parameters).adjust(&scene.window));
  for (int k = 1; k < 6; ++k) {
    EXPECT_LT(pose_error(scene.window.poses[static_cast<std::size_t>(k)].T_world_cam, true_pose(k))
                  .norm(),
              1e-4)
        << "pose " << k;
  }
}

// These are the same residuals, written independently and differentiated by Ceres.
struct Reprojection {
  StereoCalibration camera;
  ImagePoint seen;
  Eigen::Vector3d weight;

  template <typename T>
  bool operator()(const T* q, const T* t, const T* point, const T* match_error, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> R(q);
    const Eigen::Matrix<T, 3, 1> p =
        R.conjugate() * (Eigen::Map<const Eigen::Matrix<T, 3, 1>>(point) -
                         Eigen::Map<const Eigen::Matrix<T, 3, 1>>(t));
    residual[0] = weight.x() * (camera.fx * p.x() / p.z() + camera.cx - seen.x());
    residual[1] = weight.y() * (camera.fy * p.y() / p.z() + camera.cy - seen.y());
    residual[2] = weight.z() * (camera.fx * camera.baseline / p.z() + match_error[0] - seen.z());
    return true;
  }
};

struct Smoothness {
  Vector6 weight;

  template <typename T>
  bool operator()(const T* q0, const T* t0, const T* q1, const T* t1, const T* q2, const T* t2,
                  T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Quaternion> a(q0), b(q1), c(q2);
    const Eigen::Map<const Vector> ta(t0), tb(t1), tc(t2);
    const auto rotation = [](const Quaternion& q) {
      // This is the series of 2 asin(|v|) v / |v| for small angles.
      const Vector v = q.vec() * (q.w() < T(0.0) ? T(-2.0) : T(2.0));
      const T s = v.squaredNorm() / T(4.0);
      return Vector(v * (T(1.0) + s / T(6.0) + s * s * T(3.0 / 40.0)));
    };
    const Vector linear = (b.conjugate() * (tc - tb) - a.conjugate() * (tb - ta)) / T(frame_period);
    const Vector angular =
        (rotation(b.conjugate() * c) - rotation(a.conjugate() * b)) / T(frame_period);
    for (int i = 0; i < 3; ++i) {
      residual[i] = T(weight[i]) * linear[i];
      residual[i + 3] = T(weight[i + 3]) * angular[i];
    }
    return true;
  }
};

struct SmallMatchError {
  double weight;
  template <typename T>
  bool operator()(const T* match_error, T* residual) const {
    residual[0] = weight * match_error[0];
    return true;
  }
};

TEST(BundleAdjustment, FindsTheMinimumThatCeresFinds) {
  Scene scene(6, 60, 0.3);
  StereoParameters& p = scene.parameters;
  p.window_iterations = 50;
  p.outlier_sigmas = 1e3;  // Ceres's Huber loss has no such limit
  std::vector<Eigen::Quaterniond> q;
  std::vector<Eigen::Vector3d> t, points;
  std::vector<double> match_error(scene.window.points.size(), 0.0);
  for (const WindowPose& pose : scene.window.poses) {
    q.emplace_back(pose.T_world_cam.linear());
    t.emplace_back(pose.T_world_cam.translation());
  }
  for (const WindowPoint& point : scene.window.points) points.push_back(point.p_world);

  ceres::Problem problem;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < q.size(); ++k) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<Reprojection, 3, 4, 3, 3, 1>(new Reprojection{
              scene.camera,
              scene.window.points[i].sights[k].image,
              {1.0 / p.sigma_track, 1.0 / p.sigma_track, 1.0 / p.sigma_disparity}}),
          new ceres::HuberLoss(p.huber), q[k].coeffs().data(), t[k].data(), points[i].data(),
          &match_error[i]);
    }
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SmallMatchError, 1, 1>(
                                 new SmallMatchError{1.0 / p.sigma_match}),
                             nullptr, &match_error[i]);
  }
  Vector6 weight;
  weight << Eigen::Vector3d::Constant(1.0 / (p.sigma_acceleration * frame_period)),
      Eigen::Vector3d::Constant(1.0 / (p.sigma_turn_acceleration * frame_period));
  for (std::size_t k = 0; k + 2 < q.size(); ++k) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Smoothness, 6, 4, 3, 4, 3, 4, 3>(new Smoothness{weight}),
        nullptr, q[k].coeffs().data(), t[k].data(), q[k + 1].coeffs().data(), t[k + 1].data(),
        q[k + 2].coeffs().data(), t[k + 2].data());
  }
  for (auto& quaternion : q)
    problem.SetManifold(quaternion.coeffs().data(), new ceres::EigenQuaternionManifold);
  problem.SetParameterBlockConstant(q[0].coeffs().data());
  problem.SetParameterBlockConstant(t[0].data());
  ceres::Solver::Options options;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  BundleAdjustment adjustment(scene.camera, p);
  ASSERT_TRUE(adjustment.adjust(&scene.window));
  EXPECT_NEAR(0.5 * adjustment.cost(scene.window), summary.final_cost, 1e-3 * summary.final_cost);
  for (std::size_t k = 1; k < q.size(); ++k) {
    const Eigen::Isometry3d ceres_pose = Eigen::Translation3d(t[k]) * q[k];
    EXPECT_LT(pose_error(scene.window.poses[k].T_world_cam, ceres_pose).norm(), 2e-3)
        << "pose " << k;
  }
}

TEST(BundleAdjustment, WrongSightsDoNotBendThePoses) {
  Scene clean(6, 60, 0.1);
  Scene spoilt(6, 60, 0.1);
  for (std::size_t i = 0; i < 12; ++i) spoilt.window.points[i].sights[4].image.x() += 25.0;
  ASSERT_TRUE(BundleAdjustment(clean.camera, clean.parameters).adjust(&clean.window));
  ASSERT_TRUE(BundleAdjustment(spoilt.camera, spoilt.parameters).adjust(&spoilt.window));
  EXPECT_LT(pose_error(spoilt.window.poses.back().T_world_cam, true_pose(5)).norm(), 0.02);
  EXPECT_LT(
      pose_error(spoilt.window.poses.back().T_world_cam, clean.window.poses.back().T_world_cam)
          .norm(),
      0.01);
}

TEST(Window, StandingStillKeepsTheOldPosesAndItsBounds) {
  Scene scene(6, 40, 0.0);
  const Time oldest = scene.window.poses.front().stamp;
  std::vector<int> all(40);
  for (int i = 0; i < 40; ++i) all[static_cast<std::size_t>(i)] = i;
  for (int k = 6; k < 30; ++k) {
    std::vector<StereoTrack> tracks;
    for (const WindowPoint& point : scene.window.points) {
      const ImagePoint seen =
          project(scene.camera, scene.window.newest().T_world_cam.inverse() * point.p_world);
      const StereoObservation at{seen.x(), seen.y(), seen.x() - seen.z(), seen.y()};
      tracks.push_back({point.id, at, at});
    }
    scene.window.add(scene.camera, at(k), scene.window.newest().T_world_cam, tracks, all, 0.0);
    EXPECT_LE(scene.window.poses.size(), 6u);
  }
  EXPECT_EQ(scene.window.points.size(), 40u);
  EXPECT_LE(scene.window.poses.front().stamp, oldest + from_seconds(2 * frame_period));
  EXPECT_EQ(scene.window.newest().stamp, at(29));
}

TEST(BundleAdjustment, AllocatesNothing) {
  Scene scene(6, 60, 0.3);
  BundleAdjustment adjustment(scene.camera, scene.parameters);
  ASSERT_TRUE(adjustment.adjust(&scene.window));
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  const long before = maploop::testing::thread_allocations();
  ASSERT_TRUE(adjustment.adjust(&scene.window));
  EXPECT_EQ(maploop::testing::thread_allocations(), before);
}

}  // namespace
}  // namespace maploop::stereo
