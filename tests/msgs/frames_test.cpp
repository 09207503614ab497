#include "msgs/frames.h"

#include <gtest/gtest.h>

namespace maploop {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Frames, AnglesWrapIntoOneTurn) {
  EXPECT_DOUBLE_EQ(wrap_angle(0.0), 0.0);
  EXPECT_DOUBLE_EQ(wrap_angle(-pi), pi);
  EXPECT_NEAR(wrap_angle(3.0 * pi), pi, 1e-12);
  EXPECT_NEAR(wrap_angle(-2.5 * pi), -0.5 * pi, 1e-12);
}

TEST(Frames, AzimuthIsClockwiseFromNorthYawCounterClockwiseFromEast) {
  EXPECT_NEAR(azimuth_from_yaw(0.0), pi / 2.0, 1e-15);  // east
  EXPECT_NEAR(azimuth_from_yaw(pi / 2.0), 0.0, 1e-15);  // north
  EXPECT_NEAR(azimuth_from_yaw(pi), -pi / 2.0, 1e-15);  // west
  EXPECT_NEAR(yaw_from_azimuth(azimuth_from_yaw(2.0)), 2.0, 1e-15);
}

TEST(Frames, NoseUpPointsForwardUpAndRightSideDownPointsLeftUp) {
  const Eigen::Matrix3d climbing = rotation_enu_body({0.0, 0.1, 0.0});
  EXPECT_NEAR(
      (climbing * Eigen::Vector3d::UnitX() - Eigen::Vector3d(0.0, std::cos(0.1), std::sin(0.1)))
          .norm(),
      0.0, 1e-15);
  const Eigen::Matrix3d rolled = rotation_enu_body({0.0, 0.0, 0.1});
  EXPECT_GT((rolled * Eigen::Vector3d::UnitY()).z(), 0.09);
}

TEST(Frames, AttitudeSurvivesTheRoundTrip) {
  for (const double azimuth : {-3.0, -0.1, 0.0, 1.5, 3.1}) {
    for (const double pitch : {-0.3, 0.0, 0.2}) {
      for (const double roll : {-0.2, 0.0, 0.25}) {
        const Attitude a = attitude_from_rotation(rotation_enu_body({azimuth, pitch, roll}));
        EXPECT_NEAR(a.azimuth, azimuth, 1e-12);
        EXPECT_NEAR(a.pitch, pitch, 1e-12);
        EXPECT_NEAR(a.roll, roll, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace maploop
