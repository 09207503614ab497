#include "mapmatch/nav_matcher.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tests/mapmatch/default_rule_bases.h"
#include "tests/mapmatch/small_map.h"
#include "tests/support/counted_allocations.h"

namespace maploop::mapmatch {
namespace {

using maploop::testing::rules;
using maploop::testing::SmallMap;
using ::testing::HasSubstr;

// The road leads 300 m to the north, then 200 m to the east.
const RoadNetwork& network() {
  static const RoadNetwork roads = SmallMap()
                                       .node(1, 0, 0)
                                       .node(2, 0, 300)
                                       .node(3, 200, 300)
                                       .node(4, -200, 300)
                                       .way(10, {1, 2})
                                       .way(11, {4, 2, 3})
                                       .network();
  return roads;
}

// Returns a state at the place, in a frame whose origin is 1 km to the south-west of the map's.
NavState state_at(double seconds, double east, double north, double azimuth) {
  NavState state;
  state.status = NavStatus::aided;
  state.stamp = Time(from_seconds(1e9 + seconds));
  state.origin = SmallMap::place(-1000.0, -1000.0);
  state.origin.height = 110.0;
  Geodetic place = SmallMap::place(east, north);
  place.height = 112.0;
  state.position_enu = LocalFrame(state.origin).to_enu(place);
  state.attitude.azimuth = azimuth;
  state.forward_speed = 10.0;
  state.covariance.diagonal() << 4, 4, 4, 0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4;
  return state;
}

// Returns a drive north along the road, 2 m to the right of its line, at 10 m/s for 25 s at 10 Hz.
std::vector<NavState> drive_north() {
  std::vector<NavState> states;
  states.reserve(250);
  for (int i = 0; i < 250; ++i) states.push_back(state_at(0.1 * i, 2.0, 1.0 * i, 0.0));
  return states;
}

// Returns a motion that starts 0.1 s before `seconds` and turns right by `degrees_a_second`.
RelativeMotion visual_motion(double seconds, double degrees_a_second) {
  RelativeMotion motion;
  motion.status = OdometryStatus::ok;
  motion.stamp = Time(from_seconds(1e9 + seconds));
  motion.from = motion.stamp - std::chrono::milliseconds(100);
  motion.translation.x() = 0.8;
  motion.rotation = Eigen::AngleAxisd(radians(-0.1 * degrees_a_second), Eigen::Vector3d::UnitZ());
  return motion;
}

TEST(NavMatcher, ReportsWhereOnTheRoadTheStateIs) {
  NavMatcher matcher(network(), rules(), {});
  MapMatch match;
  for (const NavState& state : drive_north()) match = matcher.add(state);
  ASSERT_TRUE(match.on_road);
  EXPECT_EQ(match.phase, MatchPhase::along_link);
  EXPECT_EQ(match.stamp, drive_north().back().stamp);
  EXPECT_EQ(match.way_id, 10);
  EXPECT_EQ(match.node_a, 1);
  EXPECT_EQ(match.node_b, 2);
  EXPECT_NEAR(match.cross_track, 2.0, 0.02) << "to the right";
  EXPECT_NEAR(match.link_azimuth, 0.0, 1e-3);
  EXPECT_NEAR(match.bend, 0.0, 1e-3);
  EXPECT_NEAR(match.half_width, 2.75, 1e-9) << "a residential road";
  EXPECT_NEAR(match.along, 249.0, 1.5);
  EXPECT_NEAR(match.along + match.to_junction, 300.0, 0.5);
  EXPECT_GT(match.probability, 0.95);
  EXPECT_GT(match.margin, 0.9);
  // The matched point and its normal reproduce the state's position across the road.
  const Eigen::Vector2d right(std::cos(match.link_azimuth), -std::sin(match.link_azimuth));
  EXPECT_NEAR(right.dot(match.vehicle_enu - match.matched_enu), match.cross_track, 1e-9);
  ASSERT_GE(match.candidate_count, 1U);
  EXPECT_EQ(match.candidates[0].way_id, 10);
  EXPECT_EQ(match.candidates[0].node_b, 2);

  const MapMatchWords words = in_words(match, network(), rules());
  EXPECT_THAT(words.explanation, HasSubstr("way 10, P "));
  ASSERT_EQ(words.candidates.size(), match.candidate_count);
  EXPECT_EQ(words.candidates[0].road, "way 10");
  ASSERT_FALSE(words.candidates[0].rules.empty());
  EXPECT_THAT(words.candidates[0].rules[0], HasSubstr("then"));
}

TEST(NavMatcher, ToTheLeftOfTheRoadIsNegativeWhicheverWayItIsDriven) {
  NavMatcher matcher(network(), rules(), {});
  MapMatch match;
  for (int i = 0; i < 150; ++i)  // driving south, east is on the left
    match = matcher.add(state_at(0.1 * i, 2.0, 280.0 - 1.0 * i, radians(180.0)));
  ASSERT_TRUE(match.on_road);
  EXPECT_NEAR(match.cross_track, -2.0, 0.02);
  EXPECT_NEAR(std::abs(match.link_azimuth), radians(180.0), 1e-3);
  EXPECT_EQ(match.node_a, 2);
  EXPECT_NEAR(match.to_junction, 131.0, 1.5);
}

// The way leads to the south, against the order in which the link is stored.
TEST(NavMatcher, SaysInWhichLaneTheVehicleIs) {
  Road road;
  road.lanes = 3;
  road.lanes_backward = 2;
  const RoadNetwork roads =
      SmallMap().node(1, 0.0, 0.0).node(2, 0.0, 300.0).way(10, {2, 1}, road).network();
  MatchParameters parameters;
  parameters.lane_sigma = 0.5;
  NavMatcher matcher(roads, rules(), parameters);
  MapMatch match;
  for (NavState state : drive_north()) {
    state.covariance(0, 0) = 0.01;
    match = matcher.add(state);
  }
  ASSERT_TRUE(match.on_road);
  EXPECT_EQ(match.lane.lanes, 2);
  EXPECT_EQ(match.lane.lane, 2) << "2 m to the right; the middles are at 0 and 2.75 m";
  EXPECT_NEAR(match.lane.offset, -0.75, 0.02);
  EXPECT_NEAR(match.lane.probability, 0.99, 0.01);
}

TEST(NavMatcher, WithoutAPositionThereIsNoLinkAndTheReason) {
  NavMatcher matcher(network(), rules(), {});
  MapMatch match = matcher.add(NavState{});
  EXPECT_EQ(match.refusal, FixRefusal::no_position);
  EXPECT_FALSE(match.on_road);
  for (const NavState& state : drive_north()) match = matcher.add(state);
  ASSERT_TRUE(match.on_road);
  NavState broken = drive_north().back();
  broken.stamp += std::chrono::milliseconds(100);
  broken.position_enu.x() = std::nan("");
  match = matcher.add(broken);
  EXPECT_EQ(match.refusal, FixRefusal::not_finite);
  EXPECT_FALSE(match.on_road) << "what was before is not said again";
  EXPECT_EQ(match.candidate_count, 0U);
}

TEST(NavMatcher, SavedAndLoadedItGoesOnWithTheSameBits) {
  const auto states = drive_north();
  NavMatcher whole(network(), rules(), {});
  NavMatcher resumed(network(), rules(), {});
  for (std::size_t i = 0; i < 120; ++i) {
    whole.add(visual_motion(0.1 * static_cast<double>(i), 0.0));
    whole.add(states[i]);
  }
  ArchiveWriter writer;
  writer(whole);
  EXPECT_LE(writer.content().size(), sizeof(NavMatcher)) << "what a stage maps for it";
  ArchiveReader reader(writer.content());
  reader(resumed);
  reader.finish();
  for (std::size_t i = 120; i < states.size(); ++i) {
    for (NavMatcher* matcher : {&whole, &resumed})
      matcher->add(visual_motion(0.1 * static_cast<double>(i), 0.0));
    const MapMatch& a = whole.add(states[i]);
    const MapMatch& b = resumed.add(states[i]);
    ASSERT_EQ(a.link, b.link);
    ASSERT_EQ(a.probability, b.probability);
    ASSERT_EQ(a.matched_enu, b.matched_enu);
    ASSERT_EQ(a.candidate_count, b.candidate_count);
    ASSERT_EQ(a.candidates[0].weights, b.candidates[0].weights);
    ASSERT_EQ(a.candidates[0].rules, RuleBase::along_visual);
    ASSERT_EQ(b.candidates[0].rules, RuleBase::along_visual);
  }
}

TEST(VisualCourse, IsCarriedOnToTheFix) {
  VisualCourse course;
  VehicleFix fix;
  course.describe(fix);
  EXPECT_TRUE(std::isnan(fix.visual_speed)) << "nothing seen yet";
  for (int i = 0; i <= 10; ++i) {
    course.add(visual_motion(0.1 * i, 20.0));
    fix.stamp = Time(from_seconds(1e9 + 0.1 * i + 0.06));
    const double before = fix.visual_azimuth;
    course.describe(fix);
    EXPECT_NEAR(fix.visual_speed, 8.0, 1e-9);
    if (i == 0) {
      EXPECT_TRUE(std::isnan(fix.visual_azimuth)) << "no change may be taken from here";
    } else if (i > 1) {
      EXPECT_NEAR(degrees(wrap_angle(fix.visual_azimuth - before)), 2.0, 1e-5);
    }
  }
  fix.stamp += std::chrono::milliseconds(300);
  course.describe(fix);
  EXPECT_TRUE(std::isnan(fix.visual_azimuth)) << "too old";
}

TEST(VisualCourse, RestartsAfterAMissingOrRefusedMotion) {
  for (const bool refused : {false, true}) {
    VisualCourse course;
    VehicleFix fix;
    std::vector<bool> known;
    for (int i = 0; i < 10; ++i) {
      RelativeMotion motion = visual_motion(0.1 * i, 0.0);
      if (i == 5) motion.status = OdometryStatus::too_dark;
      if (refused || i != 5) course.add(motion);
      fix.stamp = motion.stamp;
      course.describe(fix);
      known.push_back(!std::isnan(fix.visual_azimuth));
    }
    const std::vector<bool> expected{false,    true,  true, true, true,
                                     !refused, false, true, true, true};
    EXPECT_EQ(known, expected) << refused;
  }
}

TEST(NavMatcher, AllocatesNothing) {
  if (!testing::counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  NavMatcher matcher(network(), rules(), {});
  const auto states = drive_north();
  const long before = testing::thread_allocations();
  for (std::size_t i = 0; i < states.size(); ++i) {
    matcher.add(visual_motion(0.1 * static_cast<double>(i), 0.0));
    matcher.add(states[i]);
  }
  EXPECT_EQ(testing::thread_allocations() - before, 0);
}

}  // namespace
}  // namespace maploop::mapmatch
