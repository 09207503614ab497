// These tests cover the frame of odometry, and what the filter learns about a vehicle that was
// described wrongly, on drives of known truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using Eigen::Vector3d;

constexpr double seconds = 60.0;

MotionProfile town() {
  MotionProfile profile;
  profile.speed = [](double t) { return 8.0 + 4.0 * std::sin(t / 7.0); };
  profile.yaw_rate = [](double t) { return 0.35 * std::pow(std::sin(t / 6.0), 3); };
  profile.azimuth = 0.8;
  return profile;
}

// Returns the fixes of a receiver that is wrong by `shift` from `from` on (s).
std::vector<GnssFix> fixes(const SyntheticDrive& drive, const Vector3d& shift, double from) {
  const LocalFrame frame(test_origin());
  std::vector<GnssFix> all;
  for (int i = 0; i < static_cast<int>(seconds); ++i) {
    GnssFix f = drive.fix(i);
    f.available = f.stamp + from_seconds(0.1);
    f.sequence = static_cast<std::uint64_t>(i);
    if (i >= from) f.position = frame.to_geodetic(frame.to_enu(f.position) + shift);
    all.push_back(f);
  }
  return all;
}

Eigen::Isometry3d odom_pose(const FusedState& s) {
  return Eigen::Translation3d(s.odom.position) *
         Eigen::Quaterniond(rotation_enu_body(s.odom.attitude));
}

// Returns the states every 0.1 s, each from what has arrived by then.
std::vector<FusedState> states(ReducedImuFilter& filter, std::vector<Measurement> all) {
  sort_as_available(all);
  std::vector<FusedState> result;
  auto next = all.begin();
  for (int i = 10; i < static_cast<int>(10.0 * seconds); ++i) {
    const Time t = SyntheticDrive::at(0.1 * i);
    for (; next != all.end() && available_of(*next) <= t; ++next) add(filter, *next);
    if (const auto state = filter.state_at(t)) result.push_back(*state);
  }
  return result;
}

double largest_step_error(const SyntheticDrive& drive, const std::vector<FusedState>& states,
                          const std::function<Eigen::Isometry3d(const FusedState&)>& pose) {
  double largest = 0.0;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const auto true_pose = [&](const FusedState& s) {
      return drive.pose(to_seconds(s.stamp - SyntheticDrive::at(0.0)));
    };
    const Vector3d moved = (pose(states[i - 1]).inverse() * pose(states[i])).translation();
    const Vector3d truth =
        (true_pose(states[i - 1]).inverse() * true_pose(states[i])).translation();
    largest = std::max(largest, (moved - truth).norm());
  }
  return largest;
}

TEST(TwoOutputs, AFixThatJumpsMovesTheMapAndNotTheFrameOfOdometry) {
  const SyntheticDrive drive(town(), seconds, test_origin());
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  append(all, fixes(drive, {60.0, -40.0, 0.0}, 20.0));
  const std::vector<FusedState> out = states(filter, all);
  ASSERT_GT(out.size(), 500u);
  EXPECT_GT(largest_step_error(drive, out, [](const FusedState& s) { return pose_of(s); }), 10.0);
  EXPECT_LT(largest_step_error(drive, out, odom_pose), 0.05);
  EXPECT_GE(filter.status().recoveries + filter.status().reinitializations, 1u);
}

TEST(TwoOutputs, WithoutOdometryTheFrameOfOdometryDoesNotJumpEither) {
  const SyntheticDrive drive(town(), seconds, test_origin());
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, fixes(drive, {60.0, -40.0, 0.0}, 20.0));
  const std::vector<FusedState> out = states(filter, all);
  EXPECT_GT(largest_step_error(drive, out, [](const FusedState& s) { return pose_of(s); }), 10.0);
  EXPECT_LT(largest_step_error(drive, out, odom_pose), 0.2);
}

TEST(TwoOutputs, OfAFilterWithoutAbsoluteAidsAreTheSame) {
  const SyntheticDrive drive(town(), seconds, test_origin());
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  std::vector<Measurement> all;
  append(all, drive.imu(100.0));
  append(all, drive.odometry(10.0));
  append(all, fixes(drive, Vector3d::Zero(), 0.0));
  for (const FusedState& s : states(filter, all)) {
    // They differ by what odometry corrects of its own start.
    EXPECT_LT((s.odom.position - s.position_enu).norm(), 0.5);
    EXPECT_EQ(s.odom.stamp, s.stamp);
  }
}

// The body that odometry, fixes and inertial unit belong to is turned against the vehicle and lies
// ahead of the rear axle, on which the vehicle rolls.
class Misdescribed : public ::testing::Test {
 protected:
  Misdescribed() : drive_(town(), seconds, test_origin()) {
    T_vehicle_body_ =
        Eigen::Translation3d(1.2, 0.0, 0.0) * Eigen::AngleAxisd(radians(2.0), Vector3d::UnitZ());
  }

  std::vector<Measurement> measurements() const {
    std::vector<Measurement> all;
    append(all, drive_.imu(100.0));
    for (RelativeMotion m : drive_.odometry(10.0)) {
      const Eigen::Isometry3d T = T_vehicle_body_.inverse() * m.T_from_to() * T_vehicle_body_;
      m.translation = T.translation();
      m.rotation = Eigen::Quaterniond(T.rotation());
      all.push_back(m);
    }
    const LocalFrame frame(test_origin());
    for (GnssFix f : fixes(drive_, Vector3d::Zero(), 0.0)) {
      const double t = to_seconds(f.stamp - SyntheticDrive::at(0.0));
      f.position = frame.to_geodetic((drive_.pose(t) * T_vehicle_body_).translation());
      f.velocity_covariance *= 0.01;
      all.push_back(f);
    }
    return all;
  }

  CalibratedProperty find(const ReducedImuFilter& filter, std::string_view name) const {
    const SelfCalibrations all = filter.calibration();
    return *std::find_if(all.begin(), all.end(),
                         [&](const CalibratedProperty& c) { return c.name.starts_with(name); });
  }

  SyntheticDrive drive_;
  Eigen::Isometry3d T_vehicle_body_;
};

TEST_F(Misdescribed, TheFilterLearnsTheAxleAndTheDirectionOfTravel) {
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  add_as_available(filter, measurements());
  const CalibratedProperty course = find(filter, "odometry points to the right");
  EXPECT_TRUE(course.observed());
  EXPECT_NEAR(course.value, 2.0, 0.2) << "deg";
  EXPECT_LT(course.sigma, 0.3);
  const CalibratedProperty axle = find(filter, "rear axle");
  EXPECT_TRUE(axle.observed());
  EXPECT_NEAR(axle.value, 1.2, 0.15) << "m";
  EXPECT_FALSE(find(filter, "GNSS antenna, forward").observed()) << "no fix after the start";
}

TEST_F(Misdescribed, TheFilterLearnsThatOdometryIsFromFurtherToTheLeft) {
  const Eigen::Translation3d wrong(0.0, 0.5, 0.0);  // m
  std::vector<Measurement> all;
  append(all, drive_.imu(100.0));
  for (GnssFix f : fixes(drive_, Vector3d::Zero(), 0.0)) {
    f.velocity_covariance *= 0.01;
    all.push_back(f);
  }
  for (RelativeMotion m : drive_.odometry(10.0)) {
    const Eigen::Isometry3d T = wrong * m.T_from_to() * wrong.inverse();
    m.translation = T.translation();
    all.push_back(m);
  }
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  const std::vector<FusedState> out = states(filter, all);
  const CalibratedProperty place = find(filter, "odometry described too far to the left");
  EXPECT_GT(place.value, 0.25) << "m";
  EXPECT_NEAR(place.value, 0.5, 2.0 * place.sigma) << "m";
  EXPECT_LT(place.sigma, 0.2) << "m, of 0.3 at the start";
}

// The nose of this car points into a turn by 0.009 rad for each m/s^2 of lateral acceleration.
TEST(RearSlip, IsLearntInTurnsOfSeveralSpeeds) {
  constexpr double rear_slip = 0.009;  // rad/(m/s^2)
  MotionProfile turns;
  turns.speed = [](double t) { return 9.0 + 5.0 * std::sin(t / 11.0); };
  turns.yaw_rate = [](double t) { return 0.3 * std::sin(t / 3.0); };
  const SyntheticDrive drive(turns, 120.0, test_origin());
  const auto nose = [&](double t) { return rear_slip * turns.speed(t) * turns.yaw_rate(t); };
  const auto pose = [&](double t) -> Eigen::Isometry3d {
    return drive.pose(t) * Eigen::AngleAxisd(nose(t), Vector3d::UnitZ());
  };
  const auto time_of = [](Time t) { return to_seconds(t - SyntheticDrive::at(0.0)); };

  std::vector<Measurement> all;
  for (ImuSample sample : drive.imu(100.0)) {
    const double t = time_of(sample.stamp);
    sample.yaw_rate += (nose(t + 0.01) - nose(t - 0.01)) / 0.02;
    all.push_back(sample);
  }
  for (RelativeMotion m : drive.odometry(10.0)) {
    const Eigen::Isometry3d T = pose(time_of(m.from)).inverse() * pose(time_of(m.stamp));
    m.translation = T.translation();
    m.rotation = Eigen::Quaterniond(T.rotation());
    all.push_back(m);
  }
  all.push_back(drive.fix(0.0));
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  add_as_available(filter, all);
  const SelfCalibrations learnt = filter.calibration();
  const auto slip = std::find_if(learnt.begin(), learnt.end(),
                                 [](const CalibratedProperty& c) { return c.key == "rear_slip"; });
  ASSERT_NE(slip, learnt.end());
  EXPECT_TRUE(slip->observed());
  EXPECT_NEAR(slip->value, degrees(rear_slip), 2.0 * slip->sigma) << "deg at 1 m/s^2";
  EXPECT_LT(slip->sigma, degrees(0.001));
}

// Returns what the filter knows, as if it were `age` before the start of the drive.
RememberedCalibration remembered(const ReducedImuFilter& filter, Duration age) {
  RememberedCalibration all{SyntheticDrive::at(0.0) - age, {}, {}};
  const SelfCalibrations estimated = filter.calibration();
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    if (!estimated[i].observed()) continue;
    all.value[i] = estimated[i].value;
    all.sigma[i] = estimated[i].sigma;
  }
  return all;
}

TEST_F(Misdescribed, AnotherDriveBeginsWithWhatTheFirstHasTaught) {
  const std::vector<Measurement> all = measurements();
  ReducedImuFilter first(configured("VO-RI"), test_origin());
  add_as_available(first, all);
  const auto begin_after = [&](Duration age) {
    ReducedImuFilter filter(configured("VO-RI"), test_origin());
    filter.recall(remembered(first, age));
    for (const Measurement& m : all)
      if (!filter.initialized() && std::holds_alternative<GnssFix>(m)) add(filter, m);
    EXPECT_TRUE(filter.initialized());
    return filter;
  };
  const ReducedImuFilter soon = begin_after(std::chrono::hours(1));
  EXPECT_NEAR(find(soon, "odometry points").value, 2.0, 0.25) << "deg, before any odometry";
  EXPECT_TRUE(find(soon, "odometry points").observed());
  EXPECT_NEAR(find(soon, "rear axle").value, 1.2, 0.2) << "m";
  EXPECT_FALSE(find(soon, "GNSS antenna, forward").observed())
      << "the first drive did not teach it";
  const ReducedImuFilter late = begin_after(std::chrono::hours(24 * 3 * 365));
  EXPECT_FALSE(find(late, "odometry points").observed()) << "it may have been mounted anew";
  EXPECT_GT(find(late, "odometry points").sigma, find(soon, "odometry points").sigma);
}

TEST_F(Misdescribed, WhatContradictsTheDescriptionIsNotRemembered) {
  FusionParameters described = configured("VO-RI");
  described.rear_axle_distance = 0.2;
  described.rear_axle_sigma = 0.01;
  ReducedImuFilter first(configured("VO-RI"), test_origin());
  add_as_available(first, measurements());
  ReducedImuFilter filter(described, test_origin());
  filter.recall(remembered(first, std::chrono::hours(1)));
  for (const Measurement& m : measurements())
    if (!filter.initialized() && std::holds_alternative<GnssFix>(m)) add(filter, m);
  EXPECT_NEAR(find(filter, "rear axle").value, 0.2, 1e-9) << "m: the axle of another car";
}

TEST_F(Misdescribed, ADriveOnAKnownAxleTeachesNothingWhileItGoesStraight) {
  MotionProfile straight;
  drive_ = SyntheticDrive(straight, seconds, test_origin());
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  add_as_available(filter, measurements());
  EXPECT_FALSE(find(filter, "rear axle").observed());
}

TEST_F(Misdescribed, PosesOfTheDescribedAxesAreRightFromTheFirstOn) {
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  const std::vector<FusedState> out = states(filter, measurements());
  ASSERT_GT(out.size(), 500u);
  const auto described = [](const FusedState& s) {
    return odom_pose(s) * s.mount.T_body_described();
  };
  const auto true_pose = [&](const FusedState& s) {
    return drive_.pose(to_seconds(s.stamp - SyntheticDrive::at(0.0))) * T_vehicle_body_;
  };
  EXPECT_NEAR(out.back().mount.course, radians(2.0), radians(0.2));
  const FusedState& to = out.back();
  for (const std::size_t from : {0u, 1u, 3u, 10u, 100u}) {
    const Eigen::Isometry3d moved = described(out[from]).inverse() * described(to);
    const Eigen::Isometry3d truth = true_pose(out[from]).inverse() * true_pose(to);
    EXPECT_LT((moved.translation() - truth.translation()).norm(),
              0.005 * truth.translation().norm())
        << from;
  }
}

TEST_F(Misdescribed, TheFrameOfOdometryIsAsGoodAsOdometry) {
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  const std::vector<FusedState> out = states(filter, measurements());
  ASSERT_GT(out.size(), 500u);
  // The filter's axes are those in which the vehicle travels, whichever odometry was told.
  const Eigen::Translation3d origin(T_vehicle_body_.translation());
  const auto true_pose = [&](const FusedState& s) {
    return drive_.pose(to_seconds(s.stamp - SyntheticDrive::at(0.0))) * origin;
  };
  const Eigen::Isometry3d moved = odom_pose(out.front()).inverse() * odom_pose(out.back());
  const Eigen::Isometry3d truth = true_pose(out.front()).inverse() * true_pose(out.back());
  double way = 0.0;
  for (double t = 1.0; t < seconds; t += 0.1) way += 0.1 * drive_.speed(t);
  EXPECT_LT((moved.translation() - truth.translation()).norm(), 0.002 * way);
}

}  // namespace
}  // namespace maploop::fusion
