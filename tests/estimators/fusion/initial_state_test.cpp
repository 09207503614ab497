#include "estimators/fusion/initial_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using Eigen::Vector3d;

GnssFix moving_fix() {
  GnssFix fix;
  fix.stamp = SyntheticDrive::at(10.0);
  fix.velocity_stamp = fix.stamp;
  fix.position = LocalFrame(test_origin()).to_geodetic({100.0, 50.0, 3.0});
  fix.position_covariance = Vector3d(1.0, 2.0, 4.0).asDiagonal();
  fix.velocity_enu = {6.0, -8.0, 0.5};
  fix.velocity_covariance = Vector3d(0.01, 0.02, 0.04).asDiagonal();
  return fix;
}

FusionParameters any_slope() {
  FusionParameters p;
  p.road_slope_sigma = 1e9;
  return p;
}

TEST(InitialState, IsTheFix) {
  const FilterState s = initial_state(moving_fix(), LocalFrame(test_origin()), any_slope());
  EXPECT_EQ(s.stamp, SyntheticDrive::at(10.0));
  EXPECT_LT((s.x.segment<3>(index::east) - Vector3d(100.0, 50.0, 3.0)).norm(), 1e-6);
  EXPECT_NEAR(s.x[index::speed], std::sqrt(100.25), 1e-12);
  EXPECT_NEAR(degrees(s.x[index::azimuth]), 143.130102, 1e-6);
  EXPECT_NEAR(s.x[index::pitch], std::atan2(0.5, 10.0), 1e-12);
}

TEST(InitialState, StartsAtTheOlderVelocityAndCarriesThePositionThere) {
  GnssFix fix = moving_fix();
  fix.velocity_stamp -= from_seconds(0.06);
  const FilterState s = initial_state(fix, LocalFrame(test_origin()), any_slope());
  EXPECT_EQ(s.stamp, fix.velocity_stamp);
  const Vector3d expected = Vector3d(100.0, 50.0, 3.0) - 0.06 * fix.velocity_enu;
  EXPECT_LT((s.x.segment<3>(index::east) - expected).norm(), 1e-6);
}

TEST(InitialState, AYoungerVelocityIsLessCertainOfTheSpeed) {
  GnssFix fix = moving_fix();
  const LocalFrame frame(test_origin());
  const double same = initial_state(fix, frame, {}).P(index::speed, index::speed);
  fix.velocity_stamp += from_seconds(0.1);
  const FilterState s = initial_state(fix, frame, {});
  EXPECT_EQ(s.stamp, fix.stamp);
  EXPECT_NEAR(s.P(index::speed, index::speed), same + 0.09, 1e-9);
}

// Compares the covariance of position, speed, azimuth and pitch with a thousand noisy fixes.
TEST(InitialState, CovarianceIsThatOfNoisyFixes) {
  FusionParameters p;
  p.start_course_sigma = p.start_slope_sigma = p.climb_offset_sigma = 1e-8;
  p.gnss_lever_sigma = p.gnss_delay_sigma = 1e-8;
  p.min_position_sigma = p.min_velocity_sigma = p.speed_scale_sigma = 1e-8;
  p.road_slope_sigma = 1e9;
  const LocalFrame frame(test_origin());
  GnssFix fix = moving_fix();
  fix.velocity_stamp -= from_seconds(0.2);
  fix.position_covariance *= 1e-3;
  const FilterState mean = initial_state(fix, frame, p);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 6, 6> sample = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int runs = 4000;
  for (int i = 0; i < runs; ++i) {
    GnssFix noisy = fix;
    Vector3d dp, dv;
    for (int k = 0; k < 3; ++k) {
      dp[k] = std::sqrt(fix.position_covariance(k, k)) * normal(random);
      dv[k] = std::sqrt(fix.velocity_covariance(k, k)) * normal(random);
    }
    noisy.position = frame.to_geodetic(frame.to_enu(fix.position) + dp);
    noisy.velocity_enu += dv;
    const StateVector error = initial_state(noisy, frame, p).x - mean.x;
    sample += error.head<6>() * error.head<6>().transpose() / runs;
  }
  const Eigen::Matrix<double, 6, 1> sigma = mean.P.diagonal().head<6>().cwiseSqrt();
  const Eigen::Matrix<double, 6, 6> difference = sigma.cwiseInverse().asDiagonal() *
                                                 (sample - mean.P.topLeftCorner<6, 6>()) *
                                                 sigma.cwiseInverse().asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.08);
}

// It is the first velocity of a receiver between houses; the car drove at 11 m/s to the north.
TEST(InitialState, ACarDoesNotStartOnASteepClimb) {
  GnssFix fix = moving_fix();
  fix.velocity_enu = {-3.5, 0.4, 4.8};
  const Vector3d sigma(1.5, 1.7, 5.1);
  fix.velocity_covariance << 1.0, 0.5, -0.8, 0.5, 1.0, -0.9, -0.8, -0.9, 1.0;
  fix.velocity_covariance =
      (sigma.asDiagonal() * fix.velocity_covariance * sigma.asDiagonal()).eval();
  const FilterState s = initial_state(fix, LocalFrame(test_origin()), {});
  EXPECT_LT(std::abs(s.x[index::pitch]), 0.05);
  EXPECT_GT(std::cos(s.x[index::azimuth]), 0.5) << "the climb is correlated with it";
}

TEST(CheckFix, NamesWhatIsWrong) {
  const FusionParameters p;
  EXPECT_EQ(check_fix(moving_fix(), p), Reason::none);
  const auto reason = [&](auto spoil) {
    GnssFix fix = moving_fix();
    spoil(fix);
    return check_fix(fix, p);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reason([](GnssFix& f) { f.position.height = nan; }), Reason::not_finite);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_enu.x() = nan; }), Reason::not_finite);
  EXPECT_EQ(reason([](GnssFix& f) { f.position_covariance(0, 1) = nan; }), Reason::not_finite);
  EXPECT_EQ(reason([](GnssFix& f) { f.position.latitude = 2.0; }), Reason::out_of_range);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_enu.x() = 500.0; }), Reason::out_of_range);
  EXPECT_EQ(reason([](GnssFix& f) { f.position_covariance(1, 1) = -1.0; }),
            Reason::invalid_covariance);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_covariance(0, 1) = 0.5; }),
            Reason::invalid_covariance);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_enu = {1.0, 1.0, 0.0}; }), Reason::no_course);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_covariance(1, 1) = 1.1; }), Reason::no_course);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_stamp = {}; }), Reason::stamps_apart);
  EXPECT_EQ(reason([](GnssFix& f) { f.velocity_stamp = Time::max(); }), Reason::stamps_apart);
  EXPECT_EQ(reason([](GnssFix& f) { f.stamp = f.velocity_stamp = Time::min(); }),
            Reason::out_of_range);
}

}  // namespace
}  // namespace maploop::fusion
