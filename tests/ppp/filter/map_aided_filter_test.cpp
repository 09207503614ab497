// Tests the PPP filter with the map beside the one without it, on a real drive.
#include "ppp/filter/map_aided_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "ppp/models/geodesy.h"
#include "ppp/ppp_setup.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const PppSetup& riverside() {
  static const GnssFiles files = [] {
    GnssFiles read;
    const auto folder = maploop::testing::real_data() / "gnss/riverside_drive";
    read_into(folder / "COM3_200712.obs.gz", read);
    read_into(folder / "COM3_200712.nav.gz", read);
    return read;
  }();
  static const PppSetup setup = [] {
    SetupOptions options;
    options.parameters.systems = "GEC";
    return PppSetup(files, options);
  }();
  return setup;
}

// Makes feedback of a road along the direction of travel, whose line is this far (m) to the right.
MapFeedback road_beside(const PppSolution& s, double right) {
  const Geodetic here = geodetic_from_ecef(s.position);
  const Eigen::Matrix3d R = rotation_enu_ecef(here);
  const Eigen::Vector2d v = (R * s.velocity).head<2>();
  MapFeedback f;
  f.stamp = to_utc(s.time);
  f.reason = FeedbackReason::none;
  f.position = v.norm() > 3.0;
  f.link_azimuth = std::atan2(v.x(), v.y());
  const Eigen::Vector3d to_line(right * std::cos(f.link_azimuth), -right * std::sin(f.link_azimuth),
                                0.0);
  f.point = geodetic_from_ecef(s.position + R.transpose() * to_line);
  f.cross_sigma = 1.0;
  f.lane_sigma = 1.7;
  f.azimuth_sigma = 0.05;
  f.probability = 1.0;
  return f;
}

double apart(const MapAidedFilter& filter) {
  return (filter.solution().position - filter.map_free().position).norm();
}

// Processes the epochs from `from` to `to` - 1 and calls `each` with the index of each.
void drive(MapAidedFilter& filter, std::size_t from, std::size_t to,
           const std::function<void(std::size_t)>& each) {
  const auto& epochs = riverside().observations().epochs;
  for (std::size_t i = from; i < to; ++i) {
    filter.process(epochs.at(i));
    each(i);
  }
}

TEST(MapAidedFilter, WithoutFeedbackHasTheBitsOfTheFilterAlone) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  PppFilter alone = riverside().make_filter();
  drive(filter, 0, 60, [&](std::size_t i) {
    const PppSolution& s = alone.process(riverside().observations().epochs[i]);
    ASSERT_EQ(filter.solution().position, s.position);
    ASSERT_EQ(filter.solution().covariance, s.covariance);
  });
  EXPECT_FALSE(filter.aided());
}

TEST(MapAidedFilter, TheRoadDrawsTheSolutionAndLeavesTheOtherAlone) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  PppFilter alone = riverside().make_filter();
  drive(filter, 0, 120, [&](std::size_t i) {
    const PppSolution& s = alone.process(riverside().observations().epochs[i]);
    ASSERT_EQ(filter.map_free().position, s.position);
    filter.add(road_beside(filter.map_free(), 1.0));
  });
  EXPECT_TRUE(filter.aided());
  EXPECT_GT(filter.count(MapUse::used), 50U);
  EXPECT_GT(apart(filter), 0.03) << "lane and datum leave little of a metre";
  EXPECT_LT(apart(filter), 0.5);
  EXPECT_LT(filter.solution().covariance.trace(), filter.map_free().covariance.trace());
  EXPECT_EQ(filter.restorations(), 0U);
}

// The road is, for example, a parallel one that the vehicle seems to approach gradually.
TEST(MapAidedFilter, AWrongRoadThatPassesEveryGateIsForgottenAtOnce) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  double right = 0.0, farthest = 0.0;
  bool equal = false;
  drive(filter, 0, 600, [&](std::size_t) {
    if (filter.restorations() > 0) {  // no more feedback from here on
      equal = apart(filter) == 0.0;
      return;
    }
    farthest = std::max(farthest, apart(filter));
    MapFeedback f = road_beside(filter.map_free(), right += 0.03);
    f.lane_sigma = 0.2;  // a road with a small standard deviation
    f.cross_sigma = 0.5;
    f.probability = 1.0;
    filter.add(f);
  });
  EXPECT_EQ(filter.restorations(), 1U);
  EXPECT_TRUE(equal);
  EXPECT_GT(farthest, 1.0) << "or nothing was recovered from";
  EXPECT_LT(farthest, 7.5) << "mostly up: across the road it is 2 m";
}

TEST(MapAidedFilter, BehindAWrongRoadTheMapPausesAndComesBack) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  drive(filter, 0, 200, [&](std::size_t i) {
    MapFeedback f = road_beside(filter.map_free(), i < 90 ? 1.5 : 0.0);
    if (i == 90) f.reason = FeedbackReason::inconsistent;
    if (i == 90) f.position = false;
    filter.add(f);
    if (i >= 90 && i < 100) {
      EXPECT_TRUE(filter.paused()) << i;
    } else {
      EXPECT_FALSE(filter.paused()) << i;
    }
  });
  EXPECT_GT(filter.count(MapUse::used), 100U);
  EXPECT_TRUE(filter.aided());
}

TEST(MapAidedFilter, ASolutionThatIsBetterThanTheMapIsLeftAlone) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  drive(filter, 0, 120, [&](std::size_t) {
    MapFeedback f = road_beside(filter.map_free(), 3.0);
    f.lane_sigma = 10.0;
    filter.add(f);
    ASSERT_EQ(apart(filter), 0.0);
  });
  EXPECT_EQ(filter.count(MapUse::used), 0U);
  EXPECT_GT(filter.count(MapUse::no_help), 50U);
}

TEST(MapAidedFilter, FeedbackOfAnotherTimeIsRefused) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  MapFeedback nothing_yet;
  nothing_yet.position = true;
  EXPECT_EQ(filter.add(nothing_yet), MapUse::no_position);
  std::size_t i = 0;
  do {
    drive(filter, i, i + 1, [](std::size_t) {});
    ++i;
  } while (!road_beside(filter.map_free(), 0.5).position);
  MapFeedback f = road_beside(filter.map_free(), 0.5);
  f.stamp += from_seconds(0.6);
  EXPECT_EQ(filter.add(f), MapUse::not_of_this_epoch);
  f.stamp -= from_seconds(0.2);
  EXPECT_EQ(filter.add(f), MapUse::used);
}

TEST(MapAidedFilter, GoesOnFromAnArchiveWithTheSameBits) {
  MAPLOOP_REQUIRE_REAL_DATA();
  MapAidedFilter filter = riverside().make_map_aided_filter();
  MapAidedFilter resumed = riverside().make_map_aided_filter();
  const auto feed = [](MapAidedFilter& f) { f.add(road_beside(f.map_free(), 1.0)); };
  drive(filter, 0, 60, [&](std::size_t) { feed(filter); });
  const Bytes archive = maploop::testing::saved(filter);
  EXPECT_LT(archive.size(), MapAidedFilter::largest_archive);
  maploop::testing::load(archive, resumed);
  drive(filter, 60, 90, [&](std::size_t i) {
    resumed.process(riverside().observations().epochs[i]);
    ASSERT_EQ(filter.solution().position, resumed.solution().position);
    ASSERT_EQ(filter.map_free().position, resumed.map_free().position);
    feed(filter);
    feed(resumed);
  });
  maploop::testing::expect_refuses_broken(archive, resumed);
}

}  // namespace
}  // namespace maploop::ppp
