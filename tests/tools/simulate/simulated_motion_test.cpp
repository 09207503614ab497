// Tests streets, the line driven on them, speed and pose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "tools/simulate/town/route.h"
#include "tools/simulate/town/site.h"
#include "tools/simulate/town/streets.h"

namespace maploop::simulate {
namespace {

constexpr double seconds = 60.0;

struct Town {
  explicit Town(std::uint64_t seed)
      : streets(make_town(seed)),
        terrain(seed),
        path(std::make_shared<LanePath>(
            streets,
            make_route(streets, nearest_junction(streets, {0, 0}), longest_drive(seconds), seed),
            seed)),
        profile(std::make_shared<SpeedProfile>(*path, streets, seconds, seed)),
        motion(path, profile, terrain, seed) {}

  Streets streets;
  Terrain terrain;
  std::shared_ptr<const LanePath> path;
  std::shared_ptr<const SpeedProfile> profile;
  VehicleMotion motion;
};

TEST(SimulatedTown, EverySeedHasARouteOfTenMinutesWithoutDeadEnds) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Streets town = make_town(seed);
    for (const auto& exits : town.exits()) EXPECT_GE(exits.size(), 2U) << seed;
    EXPECT_NO_THROW(make_route(town, 0, 8340.0, seed)) << seed;
  }
}

TEST(SimulatedTown, ARouteThatCannotBeIsRefused) {
  Streets streets;
  streets.junctions = {{0, 0}, {100, 0}};
  Street street;
  street.to = 1;
  street.centreline = {{0, 0}, {100, 0}};
  street.along = distances_along(street.centreline);
  streets.streets = {street};
  EXPECT_THROW(make_route(streets, 0, 500.0, 1), std::runtime_error);
  const LanePath path(streets, {{0, true}}, 1);
  EXPECT_THROW(SpeedProfile(path, streets, 60.0, 1), std::runtime_error);
}

TEST(StreetIndex, FindsTheNearestKerb) {
  const Streets town = make_town(3);
  constexpr double reach = 5.0;
  const StreetIndex index(town, reach);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(-300.0 + 0.3 * i, std::fmod(37.7 * i, 500.0) - 250.0);
    double nearest = reach;
    for (const Street& street : town.streets)
      for (std::size_t k = 0; k + 1 < street.centreline.size(); ++k) {
        const Eigen::Vector2d a = street.centreline[k], way = street.centreline[k + 1] - a;
        const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - a - t * way).norm() - street.half_width);
      }
    ASSERT_NEAR(index.to_kerb(p), nearest, 1e-9) << p.transpose();
  }
}

TEST(LanePath, KeepsToTheRightLaneAndTurnsWide) {
  const Town town(1);
  const StreetIndex index(town.streets, 2.0);
  for (const LanePath::Stretch& stretch : town.path->stretches()) {
    const Street& street = town.streets.streets[stretch.street.street];
    const double lane_end = std::min(stretch.stop_line, town.path->length()) - 5.0;
    for (double way = stretch.begin + 18.0; way < lane_end; way += 1.0) {
      const StreetPlace at = index.nearest(town.path->position(way)).first;
      ASSERT_EQ(at.street, &street) << way;
      const double right = stretch.street.forward ? -at.left : at.left;
      // The path is in its lane, or a metre to its left.
      EXPECT_GT(right, street.lane() - 1.5) << way;
      EXPECT_LT(right, street.lane() + 0.4) << way;
    }
  }
  for (double way = 0.0; way < town.path->length(); way += 0.7) {
    EXPECT_LT(std::fabs(town.path->curvature(way)), 1.0 / 5.0) << way;
    const double h = 1e-4;
    const Eigen::Vector2d numeric =
        (town.path->position(way + h) - town.path->position(way - h)) / (2.0 * h);
    if (way < 1.0 || way > town.path->length() - 1.0) continue;
    EXPECT_LT((town.path->derivative(way) - numeric).norm(), 1e-6) << way;
  }
}

TEST(SpeedProfile, IsTheDerivativeOfTheWayAndWithinWhatADriverDoes) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Town town(seed);
    for (double t = 0.0; t < seconds; t += 0.037) {
      const double h = 1e-4, speed = town.profile->speed(t);
      EXPECT_NEAR((town.profile->way(t + h) - town.profile->way(t - h)) / (2.0 * h), speed, 1e-6);
      EXPECT_NEAR((town.profile->speed(t + h) - town.profile->speed(t - h)) / (2.0 * h),
                  town.profile->acceleration(t), 1e-5);
      EXPECT_GE(speed, 0.0);
      EXPECT_LT(std::fabs(town.profile->acceleration(t)), 3.2) << seed << ' ' << t;
      const double sideways = speed * speed * town.path->curvature(town.profile->way(t));
      EXPECT_LT(std::fabs(sideways), 3.5) << seed << ' ' << t;
    }
  }
}

TEST(SpeedProfile, AStandingCarStandsExactly) {
  int standing = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Town town(seed);
    for (double t = 0.0; t < seconds; t += 0.1) {
      if (town.profile->speed(t) > 0.0) continue;
      ++standing;
      const VehicleState state = town.motion.state(t);
      EXPECT_LT(state.velocity_enu.norm(), 1e-2);
    }
  }
  EXPECT_GT(standing, 20);
}

TEST(VehicleMotion, VelocitiesAndRatesAreThoseOfThePose) {
  const Town town(2);
  for (double t = 0.5; t < seconds; t += 0.61) {
    const VehicleState state = town.motion.state(t);
    const double h = 1e-2;
    const Eigen::Isometry3d before = town.motion.pose(t - h), after = town.motion.pose(t + h);
    const Eigen::Vector3d velocity = (after.translation() - before.translation()) / (2.0 * h);
    EXPECT_LT((velocity - state.velocity_enu).norm(), 2e-2) << t;
    const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
    EXPECT_LT((turn.angle() * turn.axis() / (2.0 * h) - state.rate_body).norm(), 2e-2) << t;
    // The car moves where it points, except for the motion of its springs.
    const Eigen::Vector3d v_body = state.T_enu_body.linear().transpose() * state.velocity_enu;
    EXPECT_LT(std::fabs(v_body.y()), 0.01 + 0.01 * v_body.x()) << t;
    EXPECT_LT(state.acceleration_enu.norm(), 6.0) << t;
  }
}

TEST(Traffic, KeepsItsDistance) {
  const Town town(1);
  const auto cars = make_traffic(town.streets, town.terrain, town.motion, 12, 20.0, 1);
  ASSERT_GT(cars.size(), 3U);
  for (double t = 0.0; t < 20.0; t += 0.05)
    for (std::size_t i = 0; i < cars.size(); ++i) {
      EXPECT_GT((cars[i].position(t) - town.motion.position(t)).norm(), 5.0);
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_GT((cars[i].position(t) - cars[k].position(t)).norm(), 5.0);
    }
}

}  // namespace
}  // namespace maploop::simulate
