#include "msgs/protection_levels.h"

#include <gtest/gtest.h>
#include <cmath>

namespace maploop {
namespace {

TEST(Protection, FactorsAreThoseOfTheNormalDistribution) {
  EXPECT_NEAR(integrity_factor(0.3173105), 1.0, 1e-6);
  EXPECT_NEAR(integrity_factor(1e-4), 3.8905919, 1e-6);
  EXPECT_NEAR(integrity_factor(1e-7), 5.3267239, 1e-6);
}

TEST(Protection, AlongAndAcrossFollowTheDirectionOfTravel) {
  const Eigen::Matrix3d P = Eigen::Vector3d(0.04, 0.09, 0.25).asDiagonal();
  const auto north = protection_levels(P, {0.0, 10.0, 0.0}, 2.0);
  EXPECT_NEAR(north.along, 0.6, 1e-12);
  EXPECT_NEAR(north.across, 0.4, 1e-12);
  EXPECT_NEAR(north.up, 1.0, 1e-12);
  const auto north_east = protection_levels(P, {3.0, 3.0, 0.0}, 2.0);
  EXPECT_NEAR(north_east.along, 2.0 * std::sqrt(0.065), 1e-12);
  const auto still = protection_levels(P, {0.1, 0.0, 0.0}, 2.0);
  EXPECT_NEAR(still.along, 0.6, 1e-12) << "the larger one, whatever the direction";
  EXPECT_NEAR(still.across, 0.6, 1e-12);
}

}  // namespace
}  // namespace maploop
