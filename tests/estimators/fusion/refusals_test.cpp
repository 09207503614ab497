// Bad input of every kind is refused with a reason, counted, and has no effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "estimators/fusion/measurement_check.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class Refusals : public ::testing::Test {
 protected:
  Refusals() : drive_({}, 30.0, test_origin()), filter_({}, test_origin()) {
    for (const Measurement& m : as_available(imu_, odometry_, drive_.fix(0.0))) {
      if (stamp_of(m) <= SyntheticDrive::at(10.0)) add(filter_, m);
    }
    const auto next = [](const auto& all) {
      return *std::find_if(all.begin(), all.end(),
                           [](const auto& m) { return m.stamp > SyntheticDrive::at(10.0); });
    };
    sample_ = next(imu_);
    motion_ = next(odometry_);
    before_ = *filter_.state_at(SyntheticDrive::at(10.2));
  }

  void expect_unmoved() const {
    const NavState after = *filter_.state_at(SyntheticDrive::at(10.2));
    EXPECT_EQ(after.position_enu, before_.position_enu);
    EXPECT_EQ(after.covariance, before_.covariance);
  }

  template <class M>
  void expect_refused(const M& measurement, Reason reason) {
    const std::uint64_t count = filter_.status().refused_for(reason);
    const Outcome outcome = filter_.add(measurement);
    EXPECT_EQ(outcome, refused(reason))
        << to_string(outcome.reason) << " instead of " << to_string(reason);
    EXPECT_EQ(filter_.status().refused_for(reason), count + 1);
    expect_unmoved();
  }

  SyntheticDrive drive_;
  std::vector<ImuSample> imu_ = drive_.imu(100.0);
  std::vector<RelativeMotion> odometry_ = drive_.odometry(10.0);
  ReducedImuFilter filter_;
  ImuSample sample_;
  RelativeMotion motion_;
  NavState before_;
};

TEST_F(Refusals, OfInertialSamples) {
  const auto spoil = [&](double ImuSample::*field, double value) {
    ImuSample s = sample_;
    s.*field = value;
    return s;
  };
  for (const auto field : {&ImuSample::specific_force_forward, &ImuSample::specific_force_left,
                           &ImuSample::yaw_rate}) {
    expect_refused(spoil(field, nan), Reason::not_finite);
    expect_refused(spoil(field, infinity), Reason::not_finite);
    expect_refused(spoil(field, 1e3), Reason::out_of_range);
  }
  // Axes that the filter does not use cannot spoil it.
  sample_.six_axes = true;
  EXPECT_EQ(check_sample(spoil(&ImuSample::pitch_rate, nan), {}), Reason::none);
  FusionParameters six;
  six.inertial_axes = InertialAxes::six;
  for (const auto field :
       {&ImuSample::specific_force_up, &ImuSample::roll_rate, &ImuSample::pitch_rate}) {
    EXPECT_EQ(check_sample(spoil(field, nan), six), Reason::not_finite);
    EXPECT_EQ(check_sample(spoil(field, 1e3), six), Reason::out_of_range);
  }
}

TEST_F(Refusals, OfOdometry) {
  const auto spoil = [&](auto change) {
    RelativeMotion m = motion_;
    change(m);
    return m;
  };
  expect_refused(spoil([](auto& m) { m.translation.y() = nan; }), Reason::not_finite);
  expect_refused(spoil([](auto& m) { m.rotation.x() = nan; }), Reason::not_finite);
  expect_refused(spoil([](auto& m) { m.covariance(4, 4) = infinity; }), Reason::not_finite);
  expect_refused(spoil([](auto& m) { m.rotation.coeffs() *= 1.1; }), Reason::out_of_range);
  expect_refused(spoil([](auto& m) { m.rotation.coeffs().setZero(); }), Reason::out_of_range);
  expect_refused(spoil([](auto& m) { m.translation.x() = 1e6; }), Reason::out_of_range);
  expect_refused(spoil([](auto& m) { m.covariance(0, 0) = -1.0; }), Reason::invalid_covariance);
  expect_refused(spoil([](auto& m) { m.covariance(0, 1) = 1.0; }), Reason::invalid_covariance);
  expect_refused(spoil([](auto& m) { m.from = m.stamp; }), Reason::bad_interval);
  expect_refused(spoil([](auto& m) { m.from = m.stamp + from_seconds(0.1); }),
                 Reason::bad_interval);
  expect_refused(spoil([](auto& m) { m.from = {}; }), Reason::bad_interval);
  expect_refused(spoil([](auto& m) { m.from = Time::min(); }), Reason::bad_interval);
  expect_refused(spoil([](auto& m) { m.stamp = Time::max(); }), Reason::out_of_range);
}

TEST_F(Refusals, OfStamps) {
  const auto with_stamp = [&](Time stamp) {
    ImuSample s = sample_;
    s.stamp = s.available = stamp;
    return s;
  };
  expect_refused(with_stamp({}), Reason::out_of_range);
  expect_refused(with_stamp(Time::min()), Reason::out_of_range);
  expect_refused(with_stamp(Time::max()), Reason::out_of_range);
  expect_refused(with_stamp(SyntheticDrive::at(1.0)), Reason::too_old);
  expect_refused(with_stamp(SyntheticDrive::at(13.0)), Reason::time_jump);
  expect_refused(with_stamp(SyntheticDrive::at(1e6)), Reason::time_jump);
  expect_refused(imu_[950], Reason::duplicate);
  expect_refused(odometry_[95], Reason::duplicate);
}

TEST_F(Refusals, OfTheStartsOwnInertialSampleThatComesTwice) {
  ReducedImuFilter filter({}, test_origin());
  filter.add(imu_[100]);
  GnssFix fix = drive_.fix(0.0);
  fix.stamp = fix.velocity_stamp = fix.available = imu_[100].stamp;
  ASSERT_FALSE(filter.add(fix).refused());
  EXPECT_EQ(filter.add(imu_[100]), refused(Reason::duplicate));
  EXPECT_EQ(filter.add(imu_[99]), refused(Reason::before_start));
}

TEST_F(Refusals, OfWhatIsStampedLaterThanItWasDelivered) {
  for (const double ahead : {0.06, 1.5, 3.0, 3600.0}) {
    ImuSample sample = sample_;
    sample.stamp = sample.available + from_seconds(ahead);
    expect_refused(sample, Reason::after_delivery);
    RelativeMotion motion = motion_;
    motion.stamp = motion.available + from_seconds(ahead);
    expect_refused(motion, Reason::after_delivery);
    GnssFix fix = drive_.fix(0.0);
    fix.velocity_stamp = fix.stamp = fix.available + from_seconds(ahead);
    ReducedImuFilter waiting({}, test_origin());
    EXPECT_EQ(waiting.add(fix), refused(Reason::after_delivery));
  }
}

TEST_F(Refusals, ManyFromAClockAheadDoNotRestartTheFilter) {
  for (int i = 0; i < 2 * FusionParameters{}.restart_after; ++i) {
    ImuSample sample = sample_;
    sample.sequence += static_cast<std::uint64_t>(i);
    sample.stamp = sample.available + from_seconds(10.0 + 0.01 * i);
    expect_refused(sample, Reason::after_delivery);
  }
  EXPECT_TRUE(filter_.initialized());
}

TEST_F(Refusals, OdometryOfBadInputSaysNothingOfTheIntervalItFellInto) {
  // The motion covers the time of a pair that arrived late and was refused by the odometry.
  RelativeMotion skipped = motion_;
  skipped.status = OdometryStatus::bad_input;
  const std::vector<RelativeMotion> longer = drive_.odometry(5.0);
  const RelativeMotion across = *std::find_if(longer.begin(), longer.end(), [&](const auto& m) {
    return m.stamp > skipped.stamp && m.from >= SyntheticDrive::at(10.0);
  });
  ASSERT_LT(across.from, skipped.stamp);
  EXPECT_EQ(filter_.add(across), Outcome{});
  const NavState before = *filter_.state_at(across.stamp);
  EXPECT_EQ(filter_.add(skipped), refused(Reason::odometry_not_ok));
  const NavState after = *filter_.state_at(across.stamp);
  EXPECT_EQ(after.odometry_stamp, across.stamp);
  EXPECT_EQ(after.odometry_applied, before.odometry_applied);
}

TEST_F(Refusals, OfFixesAfterTheStart) {
  expect_refused(drive_.fix(10.0), Reason::already_started);
}

TEST_F(Refusals, OneWildStampDoesNotStopTheOthers) {
  EXPECT_EQ(filter_.add([&] {
    ImuSample s = sample_;
    s.stamp = s.available = SyntheticDrive::at(14.0);
    return s;
  }()),
            refused(Reason::time_jump));
  for (const Measurement& m : as_available(imu_, odometry_, drive_.fix(0.0))) {
    if (stamp_of(m) <= SyntheticDrive::at(10.0) || std::holds_alternative<GnssFix>(m)) continue;
    EXPECT_FALSE(add(filter_, m).refused());
  }
  EXPECT_NEAR(filter_.state_at(SyntheticDrive::at(30.0))->position_enu.y(), 300.0, 0.1);
}

TEST_F(Refusals, ARealGapCostsOneMeasurementAndIsBridged) {
  int refusals = 0;
  for (const ImuSample& s : imu_) {
    if (s.stamp >= SyntheticDrive::at(13.0) && s.stamp <= SyntheticDrive::at(14.0))
      refusals += filter_.add(s).refused() ? 1 : 0;
  }
  EXPECT_EQ(refusals, 1);
  const NavState after = *filter_.state_at(SyntheticDrive::at(14.0));
  EXPECT_EQ(after.status, NavStatus::coasting);
  EXPECT_NEAR(after.position_enu.y(), 140.0, 1.0);
  EXPECT_GT(after.covariance(1, 1), before_.covariance(1, 1));
}

TEST_F(Refusals, AClockThatReallyJumpedRestartsTheFilter) {
  for (const double jump : {-3600.0, 7200.0}) {
    const std::uint64_t restarts = filter_.status().restarts;
    GnssFix fix = drive_.fix(0.0);
    fix.stamp = fix.velocity_stamp = fix.available = SyntheticDrive::at(20.0 + jump);
    int refusals = 0;
    for (ImuSample s : imu_) {
      s.stamp += from_seconds(jump);
      s.available += from_seconds(jump);
      refusals += filter_.add(s).refused() ? 1 : 0;
    }
    EXPECT_EQ(filter_.status().restarts, restarts + 1);
    EXPECT_EQ(refusals, FusionParameters{}.restart_after);
    EXPECT_FALSE(filter_.initialized());
    EXPECT_EQ(filter_.status().phase, Phase::waiting_for_fix);
    fix.stamp = fix.velocity_stamp = fix.available = SyntheticDrive::at(29.0 + jump);
    EXPECT_EQ(filter_.add(fix), Outcome{});
    EXPECT_TRUE(filter_.state_at(SyntheticDrive::at(30.0 + jump)));
    filter_ = ReducedImuFilter({}, test_origin());
    filter_.add(drive_.fix(0.0));
    for (const ImuSample& s : imu_) filter_.add(s);
  }
}

TEST(Capacity, ASmallHistoryOnlyForgetsEarlier) {
  const SyntheticDrive drive({}, 20.0, test_origin());
  FusionParameters parameters;
  parameters.history_capacity = 50;
  ReducedImuFilter filter(parameters, test_origin());
  const std::vector<NavState> states = states_after_odometry(
      filter, as_available(drive.imu(100.0), drive.odometry(10.0), drive.fix(0.0)));
  EXPECT_GT(filter.status().shortened, 1000u);
  EXPECT_EQ(states.back().odometry_applied, 200u);
  EXPECT_NEAR(states.back().position_enu.y(), 200.0, 0.1);
}

TEST(Accounting, EveryMeasurementIsCountedOnce) {
  const SyntheticDrive drive({}, 10.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  const auto all = as_available(drive.imu(100.0), drive.odometry(10.0), drive.fix(5.0));
  for (const Measurement& m : all) {
    add(filter, m);
    add(filter, m);
  }
  const FilterStatus s = filter.status();
  EXPECT_EQ(s.applied + s.held + std::accumulate(s.refused.begin(), s.refused.end(), 0ull),
            2 * all.size());
}

TEST(Parameters, ThatCannotWorkAreNamed) {
  FusionParameters parameters;
  parameters.gyro_noise = -1.0;
  try {
    ReducedImuFilter filter(parameters);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("gyro_noise"), std::string::npos);
  }
  parameters = {};
  parameters.max_step = nan;
  EXPECT_THROW(ReducedImuFilter{parameters}, std::invalid_argument);
}

TEST(Reasons, AllHaveNames) {
  for (std::size_t i = 0; i < reason_count; ++i) {
    EXPECT_NE(to_string(static_cast<Reason>(i)), "unknown") << i;
  }
}

}  // namespace
}  // namespace maploop::fusion
