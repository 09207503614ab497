// Tests how edges and the ground, which camera and LiDAR both see, show where the LiDAR is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "msgs/frames.h"
#include "msgs/small_turn.h"
#include "tests/support/drawn.h"
#include "tools/calibrate/extrinsics/depth_edges.h"
#include "tools/calibrate/extrinsics/edge_alignment.h"
#include "tools/calibrate/extrinsics/ground_alignment.h"
#include "tools/calibrate/extrinsics/image_edges.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d, Eigen::Vector3f;

// A wall 20 m ahead, and before it a pole 0.3 m thick at 10 m, seen every 0.2 degrees.
LidarScan pole_before_wall() {
  LidarScan scan;
  scan.start = scan.stamp - from_seconds(0.05);
  scan.end = scan.stamp + from_seconds(0.05);
  for (double azimuth = 30.0; azimuth > -30.0; azimuth -= 0.2) {
    const double slope = std::tan(radians(azimuth));
    const bool pole = std::abs(10.0 * slope - 2.0) < 0.15;
    const auto x = static_cast<float>(pole ? 10.0 : 20.0);
    scan.points.push_back({x, x * static_cast<float>(slope), 0.05F * x, 0.0F});
  }
  return scan;
}

TEST(DepthEdges, AreTheOutermostPointsOfTheNearObject) {
  const std::vector<Vector3f> edges = depth_edges(pole_before_wall(), {}, 0.0);
  ASSERT_EQ(edges.size(), 2U);
  const auto [right, left] = std::minmax(edges[0].y(), edges[1].y());
  EXPECT_NEAR(left, 2.15, 0.04) << "0.2 deg at 10 m";
  EXPECT_NEAR(right, 1.85, 0.04);
  EXPECT_FLOAT_EQ(edges[0].x(), 10.0F);
}

TEST(DepthEdges, DoNotDependOnTheOrderOfThePoints) {
  LidarScan scan = pole_before_wall();
  const std::vector<Vector3f> edges = depth_edges(scan, {}, 0.0);
  std::ranges::reverse(scan.points);
  EXPECT_EQ(depth_edges(scan, {}, 0.0), edges);
}

TEST(DepthEdges, AreWhereTheyWereAtTheStamp) {
  const LidarScan scan = pole_before_wall();
  const std::vector<Vector3f> edges = depth_edges(scan, {{10.0, 0.0, 0.0}, Vector3d::Zero()}, 0.0);
  ASSERT_EQ(edges.size(), 2U);
  const double early = std::atan2(2.0, 10.0) / (2.0 * M_PI) * 0.1;  // s, seen from 10 m/s behind
  EXPECT_NEAR(edges[0].x(), 10.0 - 10.0 * early, 0.01);
}

TEST(DepthEdges, OfAnEmptyScanOrOfPointsThatAreNoNumbersThereAreNone) {
  LidarScan scan = pole_before_wall();
  for (LidarPoint& p : scan.points) p.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(depth_edges(scan, {}, 0.0).empty());
  scan.points.clear();
  EXPECT_TRUE(depth_edges(scan, {}, 0.0).empty());
}

TEST(VerticalEdges, FadeToBothSidesOfAChangeOfGrey) {
  GreyImage image;
  image.resize(64, 8);
  for (int i = 0; i < 64 * 8; ++i)
    image.pixels[static_cast<std::size_t>(i)] = i % 64 < 32 ? 40 : 200;
  const GreyImage edges = vertical_edges(image);
  const auto at = [&](int x) { return edges.pixels[4 * 64 + static_cast<std::size_t>(x)]; };
  EXPECT_EQ(at(31), 255);
  EXPECT_GT(at(40), at(50));
  EXPECT_EQ(at(31 - 10), at(32 + 10)) << "symmetric";
  EXPECT_NEAR(at(51), 0.9 * at(50), 2.0);
}

TEST(VerticalEdges, OfAnImageWithoutThemAreWeak) {
  GreyImage image;
  EXPECT_TRUE(vertical_edges(image).empty());
  image.resize(16, 4);
  std::ranges::fill(image.pixels, std::uint8_t{99});
  EXPECT_EQ(std::ranges::max(vertical_edges(image).pixels), 0);
}

class Alignment : public ::testing::Test {
 protected:
  Alignment() {
    camera_.width = 600;
    camera_.height = 200;
    camera_.fx = camera_.fy = 400.0;
    camera_.cx = 300.0;
    camera_.cy = 100.0;
    camera_.baseline = 0.5;
    truth_.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    truth_.linear() = rotation_of({0.02, -0.01, 0.015}) * truth_.linear();
    truth_.translation() << 0.1, -0.2, -0.4;
    start_.rotation_covariance = 1e-4 * Eigen::Matrix3d::Identity();
  }

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine_);
  }

  Vector3f in_lidar(const Vector3d& p_cam) const {
    return (truth_.inverse() * p_cam).cast<float>();
  }

  // Ground 1.6 m below the camera, whose disparities are 0.3 px too small; a kerb of 0.3 m on the
  // right makes it a surface with some structure.
  void see_ground() {
    for (LidarView& scan : scans_) {
      for (double x = -8.0; x < 8.0; x += 0.4) {
        for (double z = 3.0; z < 30.0; z += 0.4) {
          scan.surfaces.points.push_back(
              {in_lidar({x, ground(x), z}), truth_.linear().row(1).cast<float>()});
        }
      }
    }
    for (CameraView& image : images_) {
      for (int i = 0; i < 60; ++i) {
        const double x = uniform(-5.0, 5.0);
        stereo::ImagePoint p = stereo::project(camera_, {x, ground(x), uniform(6.0, 20.0)});
        auto error = maploop::testing::drawn<Vector3d>([&] { return uniform(-0.2, 0.2); });
        error.z() -= 0.3;
        p += error;
        image.points.push_back(p);
      }
    }
  }

  static double ground(double x) { return x > 3.0 ? 1.3 : 1.6; }

  // Poles from 1 m above the camera to the ground, among other edges of the image.
  void see_poles() {
    for (std::size_t i = 0; i < images_.size(); ++i) {
      GreyImage grey;
      grey.resize(camera_.width, camera_.height);
      std::ranges::generate(grey.pixels,
                            [&] { return static_cast<std::uint8_t>(uniform(100.0, 130.0)); });
      for (int pole = 0; pole < 12; ++pole) {
        const double z = uniform(5.0, 30.0), x = uniform(-0.7, 0.7) * z;
        const auto column = static_cast<int>(camera_.cx + camera_.fx * x / z);
        const int bright = pole % 2 == 0 ? 30 : 230;
        for (int y = 0; y < camera_.height; ++y) {
          for (int u = column; u < std::min(column + 6, camera_.width); ++u) {
            const int at = y * camera_.width + u;
            grey.pixels[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(bright);
          }
        }
        for (double y = -1.0; y < 1.5; y += 0.2) scans_[i].edges.push_back(in_lidar({x, y, z}));
      }
      images_[i].edges = vertical_edges(grey);
    }
  }

  // The truth, turned and moved.
  HandEye beside(const Vector3d& turn, const Vector3d& place) const {
    HandEye pose = start_;
    pose.T_a_b = truth_;
    pose.T_a_b.linear() = rotation_of(turn) * truth_.linear();
    pose.T_a_b.translation() += place;
    return pose;
  }

  std::vector<ViewPair> views() const {
    std::vector<ViewPair> pairs;
    for (std::size_t i = 0; i < images_.size(); ++i)
      pairs.push_back({&images_[i], &scans_[i], Isometry3d::Identity(), static_cast<double>(i)});
    return pairs;
  }

  std::mt19937_64 engine_{3};
  StereoCalibration camera_;
  Isometry3d truth_ = Isometry3d::Identity();
  HandEye start_;
  std::vector<CameraView> images_{24};
  std::vector<LidarView> scans_{24};
};

TEST_F(Alignment, TheGroundShowsTheHeightAndTwoTurns) {
  see_ground();
  const HandEye off = beside({0.01, 0.0, -0.01}, {0.0, 0.2, 0.0});
  const auto found = align_ground(views(), camera_, off);
  ASSERT_TRUE(found);
  const Vector3d turn = turn_of(found->T_a_b.linear() * truth_.linear().transpose());
  EXPECT_LT(turn.norm(), 0.003);
  EXPECT_LT((found->T_a_b.translation() - truth_.translation()).norm(), 0.02);
  EXPECT_LT(found->position_sigma.y(), 0.03);
  EXPECT_EQ(found->position_sigma.z(), off.position_sigma.z()) << "not seen";
  EXPECT_EQ(found->rotation_covariance(1, 1), off.rotation_covariance(1, 1));
}

TEST_F(Alignment, EdgesShowTheThirdTurnAndTheOtherPlaces) {
  see_poles();
  const HandEye off = beside({0.0, 0.008, 0.0}, {0.2, 0.0, -0.25});
  const auto found = align_edges(views(), camera_, off);
  ASSERT_TRUE(found);
  const Vector3d turn = turn_of(found->T_a_b.linear() * truth_.linear().transpose());
  EXPECT_NEAR(turn.y(), 0.0, 0.0025);
  EXPECT_LT((found->T_a_b.translation() - truth_.translation()).norm(), 0.03);
  EXPECT_LT(found->position_sigma.x(), 0.04);
  EXPECT_EQ(found->position_sigma.y(), off.position_sigma.y()) << "not seen";
}

TEST_F(Alignment, WithoutGroundOrEdgesNothingIsFound) {
  EXPECT_FALSE(align_ground(views(), camera_, start_));
  EXPECT_FALSE(align_edges(views(), camera_, start_));
  EXPECT_FALSE(align_edges({}, camera_, start_));
}

TEST(ViewPairs, AreOfTheScanNearestByTheLidarsClock) {
  std::vector<CameraView> images(1);
  std::vector<LidarView> scans(2);
  images[0].stamp = from_nanoseconds(1'000'000'000'000) + from_seconds(0.06);
  scans[0].surfaces.stamp = from_nanoseconds(1'000'000'000'000);
  scans[1].surfaces.stamp = scans[0].surfaces.stamp + from_seconds(0.1);
  Isometry3d ahead = Isometry3d::Identity();
  ahead.translation().x() = 1.0;
  const std::vector<SensorMotion> motions{
      {scans[0].surfaces.stamp, scans[1].surfaces.stamp, ahead}};
  const auto pairs = pair_views(images, scans, motions, 0.03);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].scan, &scans[0]);
  EXPECT_NEAR(pairs[0].T_scan_image.translation().x(), 0.3, 1e-6);
  EXPECT_TRUE(pair_views(images, scans, motions, -1.0).empty());
}

}  // namespace
}  // namespace maploop::extrinsics
