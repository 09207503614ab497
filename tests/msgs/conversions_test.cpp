// Passes each struct, filled at random, through its archive and through the bytes of its message,
// and compares every member bit for bit.
#include "msgs/lcm/conversions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/archive.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/visual_motion.h"
#include "tests/msgs/random_fill.h"

namespace maploop {
namespace {

Bytes archived(const auto& value) {
  ArchiveWriter writer;
  writer(value);
  return writer.take();
}

// Restores what a message requires of its struct.
void make_valid(auto&) {}
void make_valid(Deadlines& d) {
  d.stamp = std::chrono::floor<std::chrono::microseconds>(d.stamp);
}
void make_valid(SelfCalibration& c) {
  c.stamp = std::chrono::floor<std::chrono::microseconds>(c.stamp);
}
void make_valid(Health& h) {
  h.stamp = std::chrono::floor<std::chrono::microseconds>(h.stamp);
}
void make_valid(PppState& state) {
  for (PppSatellite& satellite : state.satellites) {
    satellite.system = "GREC"[satellite.number % 4];
    satellite.number %= 100;
  }
}
void make_valid(MapMatch& match) {
  match.candidate_count %= MapMatch::max_candidates + 1;
  for (std::size_t i = match.candidate_count; i < MapMatch::max_candidates; ++i) {
    match.candidates[i] = {};
  }
}
void make_valid(MapDoubt& doubt) {
  doubt.track_count %= MapDoubt::max_points + 1;
  for (std::size_t i = 0; i < MapDoubt::max_points; ++i) {
    if (i >= doubt.track_count) doubt.track[i] = {};
    doubt.track[i].height = 0.0;
  }
}
void make_valid(LidarScan& scan) {
  scan.times.resize(scan.points.size());
}
void make_valid(StereoPair& pair) {
  pair.right.pixels.resize(pair.left.pixels.size());
  pair.left.width = pair.right.width = static_cast<int>(pair.left.pixels.size());
  pair.left.height = pair.right.height = 1;
}

template <class T>
T random_value(unsigned seed) {
  T value{};
  testing::RandomFill fill(seed);
  fill(value);
  make_valid(value);
  return value;
}

template <class Lcm>
Lcm over_the_wire(const Lcm& message) {
  Lcm received;
  EXPECT_TRUE(schema::checked_decode(schema::own_schema(), schema::encoded(message), received));
  return received;
}

template <class T>
auto message_of(const T& value) {
  if constexpr (std::is_same_v<T, MapMatch>) {
    return to_lcm(value, {});
  } else {
    return to_lcm(value);
  }
}

template <class T>
T value_of(const auto& message) {
  if constexpr (requires(T & value) { from_lcm(message, value); }) {
    T value = random_value<T>(4711);  // its buffers are reused
    from_lcm(message, value);
    return value;
  } else {
    return from_lcm(message);
  }
}

template <class T>
class Message : public ::testing::Test {};

using Messages = ::testing::Types<NavState, OdomState, NavProtection, RelativeMotion, LidarMotion,
                                  ImuSample, WheelSpeed, GnssFix, ReferencePose, MapMatch, MapDoubt,
                                  MapFeedback, PppState, Preview, Deadlines, SelfCalibration,
                                  Health, VehicleCalibration, StereoPair, LidarScan>;
TYPED_TEST_SUITE(Message, Messages);

template <class T>
void expect_archived() {
  const T value = random_value<T>(1);
  const Bytes bytes = archived(value);
  T loaded{};
  ArchiveReader reader(bytes);
  reader(loaded);
  reader.finish();
  EXPECT_EQ(archived(loaded), bytes);
  EXPECT_NE(archived(random_value<T>(2)), bytes);
}

TYPED_TEST(Message, ComesBackFromAnArchiveToTheBit) {
  expect_archived<TypeParam>();
}
TEST(Archive, AVisualMotionComesBackToTheBit) {
  expect_archived<VisualMotion>();
}

TYPED_TEST(Message, ComesBackFromLcmToTheBit) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const auto value = seed == 0 ? TypeParam{} : random_value<TypeParam>(seed);
    const auto back = value_of<TypeParam>(over_the_wire(message_of(value)));
    ASSERT_EQ(archived(back), archived(value)) << seed;
  }
}

TEST(LcmConversions, WordsOfAMatchAreInItsMessage) {
  MapMatch match;
  match.candidate_count = 2;
  const MapMatchWords words{"way 10", {{"way 10", {}, {}}, {"way 11", {"8 m away"}, {"0.25: if"}}}};
  const auto message = over_the_wire(to_lcm(match, words));
  EXPECT_EQ(message.explanation, "way 10");
  EXPECT_EQ(message.candidates[1].road, "way 11");
  EXPECT_EQ(message.candidates[1].objections, std::vector<std::string>{"8 m away"});
  EXPECT_EQ(message.candidates[1].rules, std::vector<std::string>{"0.25: if"});
}

TEST(LcmConversions, UtimeIsTheStampInMicroseconds) {
  ImuSample s;
  s.stamp = from_nanoseconds(1'317'042'651'174'740'992);
  EXPECT_EQ(to_lcm(s).header.utime, 1'317'042'651'174'740);
}

// Changes one field of the message of a value.
template <class T>
void expect_refused(const T& value, const auto& change) {
  auto message = message_of(value);
  change(message);
  EXPECT_THROW(value_of<T>(message), std::invalid_argument);
}

TEST(LcmConversions, ValuesThatAStructCannotHoldAreRefused) {
  expect_refused(NavState{}, [](auto& m) { m.status = 17; });
  expect_refused(RelativeMotion{}, [](auto& m) { m.status = -1; });
  expect_refused(MapMatch{}, [](auto& m) { m.phase = 9; });
  expect_refused(MapMatch{}, [](auto& m) { m.candidates.resize(MapMatch::max_candidates + 1); });
  expect_refused(Health{}, [](auto& m) { m.settings.resize(1), m.settings[0].verdict = 9; });
  expect_refused(Health{}, [](auto& m) { m.utime = std::numeric_limits<std::int64_t>::max(); });
  Deadlines deadlines;
  deadlines.threads.resize(1);
  expect_refused(deadlines, [](auto& m) { m.threads[0].p99_us = 1e40; });
  PppState ppp;
  ppp.satellites.resize(1);
  expect_refused(ppp, [](auto& m) { m.map = 3; });
  expect_refused(ppp, [](auto& m) { m.satellites[0].refusal = 11; });
  expect_refused(ppp, [](auto& m) { m.satellites[0].name = "E3"; });
  const auto pair = random_value<StereoPair>(5);
  expect_refused(pair, [](auto& m) { m.width = 5; });
  expect_refused(pair, [](auto& m) { m.width = m.height = -4; });
  expect_refused(LidarScan{}, [](auto& m) { m.points.resize(15); });
  StereoPair uneven;
  uneven.right.resize(3, 3);
  EXPECT_THROW(to_lcm(uneven), std::invalid_argument);
}

// The constants in the .lcm files must equal those of the enumerations.
TEST(LcmConversions, ConstantsAgree) {
  EXPECT_EQ(static_cast<int>(NavStatus::coasting), +maploop_lcm::nav_state_t::COASTING);
  EXPECT_EQ(static_cast<int>(NavStatus::aided), +maploop_lcm::nav_state_t::AIDED);
  EXPECT_EQ(static_cast<int>(NavStatus::without_course), +maploop_lcm::nav_state_t::WITHOUT_COURSE);
  EXPECT_EQ(static_cast<int>(OdometryStatus::ok), +maploop_lcm::relative_motion_t::OK);
  EXPECT_EQ(static_cast<int>(OdometryStatus::implausible),
            +maploop_lcm::relative_motion_t::IMPLAUSIBLE);
  EXPECT_EQ(static_cast<int>(OdometryStatus::bad_input),
            +maploop_lcm::relative_motion_t::BAD_INPUT);
  EXPECT_EQ(1 << static_cast<int>(MotionDirection::along), +maploop_lcm::lidar_motion_t::ALONG);
  EXPECT_EQ(1 << static_cast<int>(MotionDirection::yaw), +maploop_lcm::lidar_motion_t::YAW);
  EXPECT_EQ(static_cast<int>(MatchPhase::off_road), +maploop_lcm::map_match_t::OFF_ROAD);
  EXPECT_EQ(static_cast<int>(FixRefusal::out_of_reach), +maploop_lcm::map_match_t::OUT_OF_REACH);
  EXPECT_EQ(static_cast<int>(RuleBase::junction), +maploop_lcm::map_candidate_t::JUNCTION);
  EXPECT_EQ(static_cast<int>(Verdict::refused), +maploop_lcm::realtime_setting_t::REFUSED);
  EXPECT_EQ(static_cast<int>(Verdict::unknown), +maploop_lcm::realtime_setting_t::UNKNOWN);
}

}  // namespace
}  // namespace maploop
