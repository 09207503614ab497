// These tests cover the road as a measurement: its equations, and the filter's reaction.
#include "estimators/fusion/map_update.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/road_feedback.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

FilterState state_at_origin(double sigma) {
  FilterState state;
  state.stamp = SyntheticDrive::at(1.0);
  for (int i : {index::east, index::north}) state.P(i, i) = sigma * sigma;
  state.P(index::azimuth, index::azimuth) = 0.01;
  state.P(index::lane_offset, index::lane_offset) = 1.0;
  return state;
}

TEST(MapJacobians, AgreeWithNumericalDerivatives) {
  FilterState state;
  state.x = busy_state();
  state.x[index::lane_offset] = 0.8;
  const LocalFrame frame(test_origin());
  MapFeedback f = road(frame, {805.0, -450.0});
  f.link_azimuth = -2.2;
  const auto expect = [&](const Innovation<1>& innovation, const auto& make) {
    const auto numerical = numerical_jacobian(
        [&](const StateVector& x) {
          FilterState moved = state;
          moved.x = x;
          return Eigen::Matrix<double, 1, 1>(-make(moved).residual);
        },
        state.x);
    EXPECT_LT((innovation.H - numerical).cwiseAbs().maxCoeff(), 1e-8);
  };
  expect(line_innovation(state, f, frame),
         [&](const FilterState& s) { return line_innovation(s, f, frame); });
  expect(link_azimuth_innovation(state, f),
         [&](const FilterState& s) { return link_azimuth_innovation(s, f); });
}

TEST(MapUpdate, MovesAcrossTheRoadAndNotAlongIt) {
  const LocalFrame frame(test_origin());
  const FusionParameters p;
  FilterState state = state_at_origin(5.0);
  MapFeedback f =
      road(frame, {0.0, 30.0}, 6.0);  // the matched point lies 30 m ahead, which has no effect
  f.azimuth = false;
  ASSERT_EQ(apply_map(state, f, frame, p).disposition, Disposition::applied);
  // The expected share of the 6 m is 25 / (25 + 4 + 1).
  EXPECT_NEAR(state.x[index::east], 5.0, 1e-3);
  EXPECT_NEAR(state.x[index::north], 0.0, 1e-6);
  EXPECT_NEAR(state.x[index::lane_offset], -0.4, 1e-3);
  EXPECT_DOUBLE_EQ(state.P(index::north, index::north), 25.0);
  EXPECT_EQ(state.map_stamp, state.stamp);
}

TEST(MapUpdate, RepeatedALaneStaysUnknown) {
  const LocalFrame frame(test_origin());
  const FusionParameters p;
  FilterState state = state_at_origin(5.0);
  for (int i = 0; i < 100; ++i) apply_map(state, road(frame, {0.0, 0.0}), frame, p);
  // The white part averages out, so 1 / (1/25 + 1/4) remains.
  EXPECT_NEAR(state.P(index::east, index::east), 1.0 / (1.0 / 25.0 + 1.0 / 4.0), 0.02);
}

TEST(MapUpdate, AnotherRoadBringsAnotherLane) {
  const LocalFrame frame(test_origin());
  FusionParameters p;
  p.lane_lasting = 0.5;
  FilterState state = state_at_origin(0.1);
  for (int i = 0; i < 100; ++i) apply_map(state, road(frame, {0.0, 0.0}, -4.0), frame, p);
  const double offset = state.x[index::lane_offset];
  EXPECT_NEAR(offset, 2.0, 0.05);
  EXPECT_LT(state.P(index::lane_offset, index::lane_offset), 0.02);
  enter_road(state, p);
  EXPECT_DOUBLE_EQ(state.x[index::lane_offset], 0.5 * offset);
  EXPECT_NEAR(state.P(index::lane_offset, index::lane_offset), 0.75, 0.01);
}

TEST(MapUpdate, RefusesAnotherRoad) {
  const LocalFrame frame(test_origin());
  const FusionParameters p;
  FilterState state = state_at_origin(1.0);
  const FilterState before = state;
  MapFeedback f = road(frame, {0.0, 0.0}, 12.0);
  f.link_azimuth = 0.5;
  EXPECT_EQ(apply_map(state, f, frame, p), refused(Reason::line_gate));
  EXPECT_EQ(state.x, before.x);
  EXPECT_EQ(state.P, before.P);
  f.position = false;
  EXPECT_EQ(apply_map(state, f, frame, p), refused(Reason::link_azimuth_gate));
  EXPECT_EQ(state.map_stamp, Time{});
}

TEST(MapUpdate, DoubtsItselfWhenRoadsContradictItInARow) {
  const LocalFrame frame(test_origin());
  const FusionParameters p;
  FilterState state = state_at_origin(1.0);
  MapFeedback f = road(frame, {0.0, 0.0}, 12.0);
  f.azimuth = false;
  FilterState aided = state;  // with a recent fix, the road is wrong
  aided.gnss_stamp = aided.stamp - from_seconds(10.0);
  for (int i = 0; i < 3 * p.map_recover_after; ++i)
    EXPECT_EQ(apply_map(aided, f, frame, p), refused(Reason::line_gate));
  for (int i = 1; i < p.map_recover_after; ++i)
    EXPECT_EQ(apply_map(state, f, frame, p), refused(Reason::line_gate));
  EXPECT_FALSE(apply_map(state, f, frame, p).refused());
  EXPECT_GT(state.x[index::east], 10.0);
  EXPECT_EQ(state.recoveries, 1U);
  EXPECT_EQ(state.map_gated_in_a_row, 0);
}

TEST(MapUpdate, AHardResetBecomesTheMatchedPlace) {
  const LocalFrame frame(test_origin());
  const FusionParameters p;
  FilterState state = state_at_origin(1.0);
  state.P(index::east, index::gyro_bias) = state.P(index::gyro_bias, index::east) = 1e-3;
  MapFeedback f = road(frame, {0.0, 7.0}, 12.0);
  f.link_azimuth = 0.5;
  f.reset = true;
  ASSERT_FALSE(apply_map(state, f, frame, p).refused());
  EXPECT_NEAR(state.x[index::east], 12.0, 1e-6);
  EXPECT_NEAR(state.x[index::north], 7.0, 1e-6);
  EXPECT_DOUBLE_EQ(state.x[index::azimuth], 0.5);
  EXPECT_DOUBLE_EQ(state.P(index::east, index::gyro_bias), 0.0);
}

// Holds the result of a drive to the north with wheels and feedback of the road every second.
struct Driven {
  std::optional<NavState> end;
  FilterStatus status;
};

Driven drive_on_road(double delay, bool with_road, double gyro_bias = 0.002) {
  const SyntheticDrive drive({}, 60.0, test_origin());
  FusionParameters p = configured("RISS");
  apply_grade("mems", p);
  ReducedImuFilter filter = started_filter(p);
  const LocalFrame frame(test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0, {.gyro_bias = gyro_bias}));
  append(all, drive.wheels(0.0, 60.0));
  sort_as_available(all);
  int fed = 1;  // s, of the next feedback
  const auto feed_until = [&](Time t) {
    for (; with_road && fed <= 60 && SyntheticDrive::at(fed + delay) <= t; ++fed) {
      MapFeedback f = road(frame, drive.pose(fed).translation().head<2>());
      f.stamp = SyntheticDrive::at(fed);
      f.available = f.stamp + from_seconds(delay);
      f.sequence = static_cast<std::uint64_t>(fed);
      filter.add(f);
    }
  };
  for (const Measurement& m : all) {
    add(filter, m);
    feed_until(available_of(m));
  }
  feed_until(SyntheticDrive::at(61.0));
  return {filter.state_at(SyntheticDrive::at(60.0)), filter.status()};
}

TEST(MapFeedback, BoundsTheDriftAndShowsTheGyrosBias) {
  const Driven without = drive_on_road(0.0, false);
  const Driven with = drive_on_road(0.0, true);
  ASSERT_TRUE(without.end && with.end);
  EXPECT_GT(std::abs(without.end->position_enu.x()), 20.0);
  EXPECT_LT(std::abs(with.end->position_enu.x()), 0.5);
  EXPECT_NEAR(with.end->gyro_bias, 0.002, 2e-4);
  EXPECT_EQ(with.status.refused_for(Reason::line_gate), 0u);
}

TEST(MapFeedback, LateHasTheBitsOfTimely) {
  const Driven timely = drive_on_road(0.0, true);
  const Driven late = drive_on_road(0.7, true);
  ASSERT_TRUE(timely.end && late.end);
  EXPECT_EQ(timely.end->position_enu, late.end->position_enu);
  EXPECT_EQ(timely.end->covariance, late.end->covariance);
  EXPECT_EQ(timely.end->gyro_bias, late.end->gyro_bias);
}

TEST(MapFeedback, IsRefusedAtTheDoorWithAReason) {
  ReducedImuFilter filter(FusionParameters{}, test_origin());
  const LocalFrame frame(test_origin());
  MapFeedback f = road(frame, {0.0, 0.0});
  f.stamp = f.available = SyntheticDrive::at(1.0);
  f.point.latitude = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.add(f), refused(Reason::not_finite));
  f = road(frame, {0.0, 0.0});
  f.stamp = f.available = SyntheticDrive::at(1.0);
  f.cross_sigma = 0.0;
  EXPECT_EQ(filter.add(f), refused(Reason::invalid_covariance));
  f.cross_sigma = 1.0;
  f.position = f.azimuth = false;
  EXPECT_EQ(filter.add(f), refused(Reason::nothing_fed_back));
  f.position = true;
  f.available = f.stamp - from_seconds(1.0);
  EXPECT_EQ(filter.add(f), refused(Reason::after_delivery));
}

}  // namespace
}  // namespace maploop::fusion
