// These sensors deliver on time, but their values are wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

// The vehicle is in a bend from 10 s to 40 s.
MotionProfile bend() {
  MotionProfile profile;
  profile.speed = [](double t) { return 10.0 + 2.0 * std::sin(t / 5.0); };
  profile.yaw_rate = [](double t) { return t < 10.0 ? 0.0 : 0.3 * std::sin((t - 10.0) / 10.0); };
  return profile;
}

constexpr SensorNoise noise{.gyro_density = 8.7e-5,
                            .force_sigma = 0.2,
                            .odometry_speed_sigma = 0.05,
                            .odometry_rotation_sigma = 7e-4,
                            .seed = 7};

struct Worst {
  double position = 0.0;         // m, horizontal
  double azimuth = 0.0;          // rad
  double azimuth_in_sigmas = 0;  // 1
};

class LyingSensor : public ::testing::Test {
 protected:
  SyntheticDrive drive_{bend(), 40.0, test_origin()};
  std::vector<ImuSample> imu_ = drive_.imu(100.0, noise);
  std::vector<RelativeMotion> odometry_ = drive_.odometry(10.0, noise);
  std::function<void(int, GnssFix&)> spoil_;  // changes the fix of a second

  void move(GnssFix& fix, const Eigen::Vector3d& by) const {
    const LocalFrame frame(test_origin());
    fix.position = frame.to_geodetic(frame.to_enu(fix.position) + by);
  }

  static bool within(const Sample& s, double from, double to) {
    return s.stamp >= SyntheticDrive::at(from) && s.stamp < SyntheticDrive::at(to);
  }

  // Returns the largest errors at the motions' stamps after `from`.
  Worst run(ReducedImuFilter& filter, bool fixes, double from = 0.0) {
    std::vector<Measurement> all = as_available(imu_, odometry_, drive_.fix(0.0));
    for (int i = 1; fixes && i < 40; ++i) {
      GnssFix fix = drive_.fix(i);
      fix.sequence = static_cast<std::uint64_t>(i);
      if (spoil_) spoil_(i, fix);
      all.push_back(fix);
    }
    sort_as_available(all);
    Worst worst;
    for (const NavState& nav : states_after_odometry(filter, all)) {
      const double t = to_seconds(nav.stamp - SyntheticDrive::at(0.0));
      if (t < from) continue;
      const double azimuth = std::abs(wrap_angle(nav.attitude.azimuth - drive_.azimuth(t)));
      const Eigen::Vector3d error = nav.position_enu - drive_.pose(t).translation();
      worst.position = std::max(worst.position, error.head<2>().norm());
      worst.azimuth = std::max(worst.azimuth, azimuth);
      worst.azimuth_in_sigmas =
          std::max(worst.azimuth_in_sigmas, azimuth / std::sqrt(nav.covariance(6, 6)));
    }
    return worst;
  }
};

TEST_F(LyingSensor, OdometryThatContradictsFreshFixesMovesNothing) {
  for (RelativeMotion& m : odometry_) {
    if (within(m, 15.0, 30.0)) m.translation *= 0.15;
  }
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  EXPECT_LT(run(filter, true).position, 3.0);
  EXPECT_EQ(filter.status().refused_for(Reason::position_gate), 0u);
  EXPECT_EQ(filter.status().refused_for(Reason::speed_gate), 150u);
}

TEST_F(LyingSensor, ALastingContradictionOfTheTurningIsFollowedAndDoubtsTheAzimuth) {
  for (ImuSample& s : imu_) {
    if (within(s, 15.0, 25.0)) s.yaw_rate += 0.4;
  }
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  const Worst worst = run(filter, false, 17.0);  // from 17 s on, when the error has been detected
  EXPECT_LT(worst.azimuth, radians(40.0));
  EXPECT_LT(worst.azimuth_in_sigmas, 4.0);
  EXPECT_GE(filter.status().recoveries, 1u);
}

TEST_F(LyingSensor, AReceiverThatRepeatsAnOldFixMovesNothingUntilItIsWellAgain) {
  spoil_ = [this](int second, GnssFix& fix) {
    if (second < 12 || second > 30) return;
    const GnssFix old = drive_.fix(12);
    fix.position = old.position;
    fix.velocity_enu = old.velocity_enu;
  };
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  EXPECT_LT(run(filter, true).position, 3.0);
  EXPECT_EQ(filter.status().recoveries, 0u);
  EXPECT_EQ(filter.state_at(SyntheticDrive::at(39.5))->gnss_stamp, SyntheticDrive::at(39.0));
}

TEST_F(LyingSensor, FixesThatScatterByMoreThanTheySayMoveNothing) {
  std::mt19937 random(5);
  std::normal_distribution<double> metres(0.0, 10.0);
  spoil_ = [&](int second, GnssFix& fix) {
    if (second >= 12) move(fix, {metres(random), metres(random), 0.0});
  };
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  EXPECT_LT(run(filter, true).position, 3.0);
}

TEST_F(LyingSensor, FixesThatMoveWithTheVehicleAreBelievedInTheEnd) {
  spoil_ = [&](int second, GnssFix& fix) {
    if (second >= 12) move(fix, {60.0, 80.0, 0.0});
  };
  ReducedImuFilter filter(configured("GNSS+VO-RI"), test_origin());
  run(filter, true);
  EXPECT_GE(filter.status().recoveries, 1u);
  const auto end = filter.state_at(SyntheticDrive::at(39.5));
  EXPECT_NEAR((end->position_enu - drive_.pose(39.5).translation()).head<2>().norm(), 100.0, 3.0);
}

class FrozenImu : public LyingSensor, public ::testing::WithParamInterface<double> {};

TEST_P(FrozenImu, IsFoundAndOdometryGoesOnAlone) {
  const ImuSample stuck = imu_[2000];
  double repeated = 0.0;
  for (ImuSample& s : imu_) {
    if (!within(s, 20.0, 20.0 + GetParam())) continue;
    s.specific_force_forward = stuck.specific_force_forward;
    s.specific_force_left = stuck.specific_force_left;
    s.yaw_rate = stuck.yaw_rate;
    repeated += 1.0;
  }
  ReducedImuFilter filter(configured("VO-RI"), test_origin());
  const Worst worst = run(filter, false);
  EXPECT_LT(worst.position, 5.0);
  EXPECT_LT(worst.azimuth, radians(3.0));
  EXPECT_LT(worst.azimuth_in_sigmas, 3.5);
  // All repeated samples are refused except those of the first `imu_hold`.
  const auto refused = static_cast<double>(filter.status().refused_for(Reason::frozen));
  EXPECT_NEAR(refused, repeated - 31.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Seconds, FrozenImu, ::testing::Values(2.0, 10.0));

TEST_F(FrozenImu, IsTheSameInWhateverOrderTheSamplesCome) {
  for (ImuSample& s : imu_) {
    if (within(s, 2.0, 2.7)) {
      s.specific_force_forward = s.specific_force_left = 0.1;
      s.yaw_rate = 0.2;
    }
  }
  const auto state = [&](const std::vector<ImuSample>& samples) {
    ReducedImuFilter filter({}, test_origin());
    filter.add(drive_.fix(0.0));
    for (const ImuSample& s : samples)
      if (s.stamp < SyntheticDrive::at(2.9)) filter.add(s);
    return *filter.state_at(SyntheticDrive::at(2.9));
  };
  std::vector<ImuSample> shuffled = imu_;
  for (ImuSample& s : shuffled) s.available = {};  // disables the check of the sensor's clock
  const NavState timely = state(shuffled);
  std::mt19937 random(3);
  for (auto begin = shuffled.begin(); begin < shuffled.begin() + 240; begin += 80) {
    std::shuffle(begin, begin + 80, random);  // a stamp further ahead would need a second one
  }
  const NavState belated = state(shuffled);
  EXPECT_EQ(timely.position_enu, belated.position_enu);
  EXPECT_EQ(timely.covariance, belated.covariance);
}

// The values have steps of 0.1 m/s2 and 0.02 rad/s; when parked, such a unit shows one value for
// minutes.
TEST(CoarseImu, OfAParkedVehicleIsNotTakenForStuck) {
  MotionProfile profile;
  profile.speed = [](double t) {
    return 6.0 * (0.5 + 0.5 * std::tanh(t < 40.0 ? 20.0 - t : t - 60.0));
  };
  const SyntheticDrive drive(profile, 80.0, test_origin());
  std::vector<ImuSample> imu = drive.imu(100.0);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (ImuSample& s : imu) {
    const double t = to_seconds(s.stamp - SyntheticDrive::at(0.0));
    const double shake = drive.speed(t) > 1.0 ? 0.3 : 0.0;
    const auto rounded = [&](double v, double step, double sigma) {
      return step * std::round((v + sigma * normal(random)) / step);
    };
    s.specific_force_forward = rounded(s.specific_force_forward, 0.1, shake);
    s.specific_force_left = rounded(s.specific_force_left, 0.1, shake);
    s.yaw_rate = rounded(s.yaw_rate, 0.02, 0.02 * shake);
  }
  ReducedImuFilter filter({}, test_origin());
  const std::vector<NavState> states =
      states_after_odometry(filter, as_available(imu, drive.odometry(10.0, noise), drive.fix(0.0)));
  EXPECT_EQ(filter.status().refused_for(Reason::frozen), 0u);
  EXPECT_LT((states.back().position_enu - drive.pose(80.0).translation()).norm(), 3.0);
}

}  // namespace
}  // namespace maploop::fusion
