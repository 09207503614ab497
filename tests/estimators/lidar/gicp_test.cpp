// These tests cover the registration and its parts.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "estimators/lidar/gicp.h"
#include "estimators/lidar/scan_preparation.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tests/support/drawn.h"

namespace maploop::lidar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Adds a plane through `centre` as a grid of points.
void add_plane(const Vector3f& centre, const Vector3f& u, const Vector3f& v, int half,
               std::vector<SurfacePoint>* points) {
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      points->push_back({centre + 0.7f * (static_cast<float>(i) * u + static_cast<float>(j) * v),
                         u.cross(v).normalized()});
    }
  }
}

// Returns a scan of a road, walls on both sides, and a house across; with the house all six
// directions are determined.
PreparedScan street(bool with_house) {
  PreparedScan scan;
  add_plane({0, 0, -1.7f}, Vector3f::UnitX(), Vector3f::UnitY(), 12, &scan.points);
  add_plane({0, 9, 3}, Vector3f::UnitX(), Vector3f::UnitZ(), 12, &scan.points);
  add_plane({0, -8, 3}, Vector3f::UnitX(), Vector3f::UnitZ(), 12, &scan.points);
  if (with_house) add_plane({20, 0, 3}, Vector3f::UnitY(), Vector3f::UnitZ(), 12, &scan.points);
  return scan;
}

Eigen::Isometry3d small_motion() {
  return Twist{{0.15, -0.1, 0.05}, {0.004, -0.006, 0.01}}.over(1.0);
}

TEST(GicpFactor, MetricIsTheInverseOfTheSumOfBothCovariances) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 50; ++i) {
    const auto draw = [&] { return normal(random); };
    auto a = maploop::testing::drawn<Vector3f>(draw);
    auto b = maploop::testing::drawn<Vector3f>(draw);
    a.normalize();
    b.normalize();
    if (i == 0) b = a;
    if (i == 1) b = -a;
    const float epsilon = 1e-3f;
    const Eigen::Matrix3d sum =
        2.0 * Eigen::Matrix3d::Identity() -
        (1.0 - static_cast<double>(epsilon)) * (a.cast<double>() * a.cast<double>().transpose() +
                                                b.cast<double>() * b.cast<double>().transpose());
    const Eigen::Matrix3d expected = sum.inverse();
    EXPECT_TRUE(plane_to_plane(a, b, epsilon).cast<double>().isApprox(expected, 2e-3)) << i;
  }
}

TEST(GicpFactor, NormalEquationsAgreeWithNumericalDerivatives) {
  const Vector3f a(12.0f, -7.0f, 1.5f), target_in_body(12.2f, -6.9f, 1.45f);
  const Eigen::Matrix3f W = plane_to_plane(Vector3f(0.2f, 0.9f, 0.1f).normalized(),
                                           Vector3f(0.1f, 0.95f, 0.2f).normalized(), 1e-2f);
  Matrix6f H = Matrix6f::Zero();
  Vector6f g = Vector6f::Zero();
  add_normal_equations(a, target_in_body - a, W, 0.7f, &H, &g);

  // Returns d after the pose is perturbed on the right: the target as seen from the body, minus a.
  const auto residual = [&](const Vector6d& xi) {
    const Eigen::Isometry3d step = Twist{xi.head<3>(), xi.tail<3>()}.over(1.0);
    return Vector3d(target_in_body.cast<double>() - step * a.cast<double>());
  };
  Eigen::Matrix<double, 3, 6> J;
  for (int i = 0; i < 6; ++i) {
    const Vector6d h = 1e-6 * Vector6d::Unit(i);
    J.col(i) = (residual(h) - residual(-h)) / 2e-6;
  }
  const Eigen::Matrix3d M = 0.7 * W.cast<double>();
  const Matrix6d expected = J.transpose() * M * J;
  const Vector6d gradient = J.transpose() * M * residual(Vector6d::Zero());
  const Matrix6d found = Matrix6d(H.cast<double>().selfadjointView<Eigen::Lower>());
  EXPECT_TRUE(found.isApprox(expected, 1e-5)) << found << "\n\n" << expected;
  EXPECT_TRUE(g.cast<double>().isApprox(gradient, 1e-4));
}

TEST(LocalMap, FindsTheSamePartnersAsASearchOfAllPoints) {
  MAPLOOP_REQUIRE_DRIVE();
  const sensors::KittiDrive drive(maploop::testing::drive_0013());
  const auto scans = maploop::testing::read_scans(drive, 2);
  LidarParameters parameters = maploop::testing::lidar_parameters(drive);
  parameters.map_spacing = 0.0;
  ScanPreparation preparation(drive.calibration().T_body_velo, parameters);
  PreparedScan first, second;
  preparation.prepare(scans[0], scans[0].stamp, {}, &first);
  preparation.prepare(scans[1], scans[1].stamp, {}, &second);
  std::erase_if(first.points, [](const SurfacePoint& p) { return !p.has_normal(); });
  // The pose is far from the origin, as after an hour's drive.
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 40'000.0, -30'000.0, 200.0;
  LocalMap map(parameters);
  EXPECT_EQ(map.insert(first, T), 0);
  ASSERT_EQ(map.size(), first.points.size());
  int found = 0;
  for (std::size_t i = 0; i < second.points.size(); i += 20) {
    const Vector3f& p = second.points[i].position;
    float nearest = 4.0f;
    for (const SurfacePoint& q : first.points) nearest = std::min(nearest, (q.position - p).norm());
    const auto partner = map.nearest(T * p.cast<double>(), 2.5f);
    EXPECT_EQ(partner.has_value(), nearest < 2.5f);
    if (!partner) continue;
    ++found;
    EXPECT_NEAR(partner->offset.norm(), nearest, 1e-4f);
  }
  EXPECT_GT(found, 100);
}

TEST(LocalMap, IsBoundedAndForgetsWhatIsFar) {
  LidarParameters parameters;
  parameters.map_max_voxels = 3000;
  LocalMap map(parameters);
  const PreparedScan scan = street(true);
  int refused = 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 5; ++i) {
    T.translation().x() = 60.0 * i;
    refused += map.insert(scan, T);
  }
  EXPECT_GT(refused, 0);
  EXPECT_LE(map.size(), 30'000u);
  map.forget({1e6, 0.0, 0.0});
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.insert(scan, T), 0);
}

TEST(Gicp, FindsAMotionMadeByHand) {
  LidarParameters parameters;
  LocalMap map(parameters);
  map.insert(street(true), Eigen::Isometry3d::Identity());
  PreparedScan seen = street(true);
  const Eigen::Isometry3d T = small_motion(), T_inverse = T.inverse();
  for (SurfacePoint& p : seen.points) {
    p.position = T_inverse.cast<float>() * p.position;
    p.normal = T_inverse.linear().cast<float>() * p.normal;
  }
  const Alignment alignment =
      Gicp(parameters).align(map, seen, Eigen::Isometry3d::Identity(), true);
  EXPECT_EQ(alignment.status, OdometryStatus::ok);
  EXPECT_EQ(alignment.degeneracy.directions, 0);
  EXPECT_LT((alignment.T_map_body.translation() - T.translation()).norm(), 2e-3);
  EXPECT_LT(Eigen::AngleAxisd(alignment.T_map_body.linear().transpose() * T.linear()).angle(),
            2e-4);
}

TEST(Gicp, TunnelKeepsTheSeedAlongAndSaysSo) {
  LidarParameters parameters;
  LocalMap map(parameters);
  map.insert(street(false), Eigen::Isometry3d::Identity());
  PreparedScan seen = street(false);
  Eigen::Isometry3d seed = Eigen::Isometry3d::Identity();
  seed.translation() << 0.3, 0.1, 0.05;
  const Alignment alignment = Gicp(parameters).align(map, seen, seed, true);
  EXPECT_EQ(alignment.status, OdometryStatus::ok);
  EXPECT_EQ(alignment.degeneracy.directions, 1u << static_cast<int>(MotionDirection::along));
  EXPECT_NEAR(alignment.T_map_body.translation().x(), 0.3, 5e-3);
  EXPECT_NEAR(alignment.T_map_body.translation().y(), 0.0, 5e-3);
  EXPECT_NEAR(alignment.T_map_body.translation().z(), 0.0, 5e-3);
}

TEST(Gicp, OpenFieldDeterminesHeightRollAndPitchAlone) {
  LidarParameters parameters;
  PreparedScan field;
  add_plane({0, 0, -1.7f}, Vector3f::UnitX(), Vector3f::UnitY(), 25, &field.points);
  LocalMap map(parameters);
  map.insert(field, Eigen::Isometry3d::Identity());
  const Alignment alignment =
      Gicp(parameters).align(map, field, Eigen::Isometry3d::Identity(), true);
  const auto bit = [](MotionDirection d) { return 1u << static_cast<int>(d); };
  EXPECT_EQ(alignment.degeneracy.directions,
            bit(MotionDirection::along) | bit(MotionDirection::across) | bit(MotionDirection::yaw));
}

TEST(Gicp, ScanElsewhereHasTooFewPartners) {
  LidarParameters parameters;
  LocalMap map(parameters);
  map.insert(street(true), Eigen::Isometry3d::Identity());
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().x() = 500.0;
  EXPECT_EQ(Gicp(parameters).align(map, street(true), far, true).status,
            OdometryStatus::too_few_inliers);
}

}  // namespace
}  // namespace maploop::lidar
