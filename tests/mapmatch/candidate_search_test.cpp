#include "mapmatch/candidate_search.h"

#include <gtest/gtest.h>

#include "tests/mapmatch/small_map.h"

namespace maploop::mapmatch {
namespace {

TEST(ErrorEllipse, FollowsTheCovariance) {
  Eigen::Matrix2d covariance;
  covariance << 100.0, 0.0, 0.0, 1.0;
  const ErrorEllipse east(covariance, 0.0);
  EXPECT_TRUE(east.contains({30.0, 0.0}));
  EXPECT_FALSE(east.contains({31.0, 0.0}));
  EXPECT_FALSE(east.contains({0.0, 4.0}));
  covariance << 50.5, 49.5, 49.5, 50.5;  // 10 m along the diagonal, 1 m across
  const ErrorEllipse diagonal(covariance, 0.0);
  EXPECT_TRUE(diagonal.contains({21.0, 21.0}));
  EXPECT_FALSE(diagonal.contains({5.0, -5.0}));
  const Box box = diagonal.box({0.0, 0.0});
  EXPECT_NEAR(box.east, 3.03 * std::sqrt(50.5), 1e-9);
  EXPECT_NEAR(box.north, 3.03 * std::sqrt(50.5), 1e-9);
}

TEST(NearLinks, TheNearestComeFirstAndTheFurthestAreLeftOut) {
  testing::SmallMap map;
  for (int i = 0; i < 80; ++i) {
    map.node(2 * i + 1, -50, i * 3.0).node(2 * i + 2, 50, i * 3.0);
    map.way(i + 1, {2 * i + 1, 2 * i + 2});
  }
  const RoadNetwork network = map.network();
  NearLinks near;
  const Eigen::Vector2d place = network.to_local(testing::SmallMap::place(3, 0.5));
  find_near_links(network, place, ErrorEllipse(1e4 * Eigen::Matrix2d::Identity(), 0.0), near);
  ASSERT_EQ(near.count, NearLinks::capacity);
  EXPECT_EQ(near.left_out, 80 - NearLinks::capacity);
  for (std::size_t i = 1; i < near.count; ++i)
    EXPECT_LE(near.links[i - 1].distance, near.links[i].distance);
  EXPECT_NEAR(near.links[0].distance, 0.5, 0.01);
  EXPECT_EQ(network.road_at(near.links[0].point.vertex).way_id, 1);
}

}  // namespace
}  // namespace maploop::mapmatch
