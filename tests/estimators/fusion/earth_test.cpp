#include "estimators/fusion/earth.h"

#include <gtest/gtest.h>

#include "msgs/frames.h"

namespace maploop::fusion {
namespace {

// The expected values are published for GRS80; the error of the series is at most 2e-6.
TEST(NormalGravity, AtEquatorPoleAndFortyFiveDegrees) {
  EXPECT_NEAR(normal_gravity(0.0, 0.0), 9.7803267715, 1e-8);
  EXPECT_NEAR(normal_gravity(radians(90.0), 0.0), 9.8321863685, 2e-6);
  EXPECT_NEAR(normal_gravity(radians(45.0), 0.0), 9.8061992, 2e-6);
}

TEST(NormalGravity, FallsByThreeMicrogalPerMillimetre) {
  const double latitude = radians(49.0);
  EXPECT_NEAR((normal_gravity(latitude, 100.0) - normal_gravity(latitude, 0.0)) / 100.0, -3.086e-6,
              2e-9);
}

TEST(Radii, AtEquatorAndPole) {
  EXPECT_NEAR(prime_vertical_radius(0.0), 6378137.0, 1e-3);
  EXPECT_NEAR(meridian_radius(0.0), 6335439.327, 1e-3);
  EXPECT_NEAR(prime_vertical_radius(radians(90.0)), 6399593.626, 1e-3);
  EXPECT_NEAR(meridian_radius(radians(90.0)), 6399593.626, 1e-3);
}

// The reference is the vertical in geodetic coordinates: the direction in which the height grows.
TEST(LocalEarth, VerticalTurnsWithPosition) {
  const Geodetic origin{radians(49.0), radians(8.4), 115.0};
  const LocalFrame frame(origin);
  const LocalEarth earth(origin);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(10e3, 0, 0),
                                   Eigen::Vector3d(0, -10e3, 0), Eigen::Vector3d(8e3, 6e3, 0)}) {
    Geodetic above = frame.to_geodetic(p);
    above.height += 100.0;
    const Eigen::Vector3d vertical = (frame.to_enu(above) - p).normalized();
    const Eigen::Vector3d expected = earth.vertical(p.x(), p.y()).normalized();
    EXPECT_LT((vertical - expected).norm(), 1.1e-5) << p.transpose();
  }
}

}  // namespace
}  // namespace maploop::fusion
