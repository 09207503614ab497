#include "estimators/fusion/mechanization.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tests/estimators/fusion/least_eigenvalue.h"
#include "tests/estimators/fusion/numerical_jacobian.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

InertialInput some_input(bool inertial = true) {
  InertialInput input;
  input.duration = 0.04;
  input.inertial = inertial;
  if (inertial) {
    input.forward_force = 1.4;
    input.yaw_rate = 0.6;
    input.unseen_change = 1e-6;
    input.change.yaw_rate = 1.5;
    input.change.specific_force_forward = -6.0;
  }
  return input;
}

// Of a full unit, in a bend that goes over a crest.
InertialInput full_input() {
  InertialInput input = some_input();
  input.six_axes = true;
  input.left_force = 3.1;
  input.roll_rate = -0.2;
  input.pitch_rate = 0.15;
  input.change.specific_force_left = 4.0;
  input.change.roll_rate = -0.8;
  input.change.pitch_rate = 0.6;
  return input;
}

class Jacobian : public ::testing::TestWithParam<InertialInput> {};

TEST_P(Jacobian, AgreesWithNumericalDerivative) {
  const LocalEarth earth(test_origin());
  const FusionParameters parameters;
  const InertialInput input = GetParam();
  const StateVector x = busy_state();
  const Step step = mechanize(x, input, earth, parameters);
  const auto numerical = numerical_jacobian(
      [&](const StateVector& v) { return mechanize(v, input, earth, parameters).x; }, x);
  // The analytical derivative neglects the change of gravity with height (1e-10 here).
  EXPECT_LT((step.F - numerical).cwiseAbs().maxCoeff(), 1e-8) << step.F - numerical;
}

class EffectOfNoise : public ::testing::TestWithParam<InertialInput> {};

TEST_P(EffectOfNoise, AgreesWithNumericalDerivative) {
  const LocalEarth earth(test_origin());
  const FusionParameters parameters;
  const StateVector x = busy_state();
  const Step step = mechanize(x, GetParam(), earth, parameters);
  const auto with = [&](double force, double rate) {
    InertialInput input = GetParam();
    input.forward_force += force;
    input.yaw_rate += rate;
    return mechanize(x, input, earth, parameters).x;
  };
  constexpr double h = 1e-5;
  const StateVector by_force = (with(h, 0.0) - with(-h, 0.0)) / (2 * h);
  const StateVector by_rate = (with(0.0, h) - with(0.0, -h)) / (2 * h);
  EXPECT_LT((step.acceleration_effect - by_force).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((step.yaw_rate_effect - by_rate).cwiseAbs().maxCoeff(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Mechanization, Jacobian,
                         ::testing::Values(some_input(true), some_input(false), full_input()));
INSTANTIATE_TEST_SUITE_P(Mechanization, EffectOfNoise,
                         ::testing::Values(some_input(), full_input()));

TEST(AttitudeRates, OfThreeGyrosAreThoseOfTheRotation) {
  const LocalEarth earth(test_origin());
  InertialInput input = full_input();
  const StateVector x = busy_state();
  const AttitudeRates rates = attitude_rates(x, input, earth);
  const Eigen::Matrix3d R = rotation_enu_body({x[index::azimuth], x[index::pitch], x[index::roll]});
  const Eigen::Vector3d gyros(input.roll_rate - x[index::roll_gyro_bias],
                              input.pitch_rate - x[index::pitch_gyro_bias],
                              input.yaw_rate - x[index::gyro_bias]);
  const Eigen::Vector3d turning = R * gyros - earth.earth_rate();  // enu, against the Earth
  const auto rotated = [&](double dt) {
    const Eigen::AngleAxisd turn(dt * turning.norm(), turning.normalized());
    const Attitude a = attitude_from_rotation(turn.toRotationMatrix() * R);
    return Eigen::Vector3d(a.azimuth, a.pitch, a.roll);
  };
  constexpr double h = 1e-4;
  EXPECT_LT((rates.value - (rotated(h) - rotated(-h)) / (2 * h)).norm(), 1e-8);
}

TEST(Mechanization, ConstantTurnIsACircle) {
  const LocalEarth earth(test_origin());
  const FusionParameters parameters;
  StateVector x = StateVector::Zero();
  constexpr double rate = 0.3, v = 9.0;
  x[index::speed] = v;
  InertialInput input;
  input.inertial = true;
  input.duration = 0.01;
  input.yaw_rate = rate + earth.earth_rate_up();
  for (int i = 0; i < 1000; ++i) {
    // The plumb line tilts along the path; this force input keeps the speed constant.
    const Eigen::Vector3d forward(std::sin(x[index::azimuth]), std::cos(x[index::azimuth]), 0.0);
    input.forward_force =
        earth.gravity(0.0) * earth.vertical(x[index::east], x[index::north]).dot(forward);
    x = mechanize(x, input, earth, parameters).x;
  }
  const double angle = rate * 10.0;
  EXPECT_NEAR(x[index::east], -v / rate * (1.0 - std::cos(angle)), 1e-4);
  EXPECT_NEAR(x[index::north], v / rate * std::sin(angle), 1e-4);
  EXPECT_NEAR(wrap_angle(x[index::azimuth] + angle), 0.0, 1e-9);
  EXPECT_NEAR(x[index::speed], v, 1e-9);
}

TEST(Mechanization, AzimuthStaysWrapped) {
  const LocalEarth earth(test_origin());
  StateVector x = StateVector::Zero();
  x[index::azimuth] = std::numbers::pi - 1e-3;
  InertialInput input;
  input.inertial = true;
  input.duration = 0.1;
  input.yaw_rate = -0.5;
  x = mechanize(x, input, earth, {}).x;
  EXPECT_NEAR(x[index::azimuth], -std::numbers::pi - 1e-3 + 0.05, 1e-5);
}

// The mechanization in geodetic coordinates, with the transport rate and the azimuth from local
// north, must lead to the same places as that in the frame fixed at the origin.
TEST(Mechanization, AgreesWithGeodeticMechanizationOverTenKilometres) {
  constexpr double v = 40.0, step = 0.01, earth_rate = 7.2921151467e-5;
  const LocalFrame frame(test_origin());
  const LocalEarth earth(test_origin());
  Geodetic g = test_origin();
  double azimuth = 0.7;
  StateVector x = StateVector::Zero();
  x[index::speed] = v;
  x[index::azimuth] = azimuth;
  InertialInput input;
  input.inertial = true;
  input.duration = step;
  double worst = 0.0;
  for (int i = 0; i < 25'000; ++i) {
    const double gyro = 0.02 * std::sin(i * step / 30.0) + 1e-4;
    const double vn = v * std::cos(azimuth), ve = v * std::sin(azimuth);
    const double rn = prime_vertical_radius(g.latitude) + g.height;
    const double rm = meridian_radius(g.latitude) + g.height;
    azimuth -= step * (gyro - earth_rate * std::sin(g.latitude) - ve * std::tan(g.latitude) / rn);
    g.latitude += step * vn / rm;
    g.longitude += step * ve / (rn * std::cos(g.latitude));

    // The road follows the Earth, so a level road is nose down in the frame, and the accelerometer
    // measures nothing.
    const Eigen::Vector3d vertical = earth.vertical(x[index::east], x[index::north]);
    x[index::pitch] = -std::atan(vertical.x() * std::sin(x[index::azimuth]) +
                                 vertical.y() * std::cos(x[index::azimuth]));
    input.yaw_rate = gyro;
    x = mechanize(x, input, earth, {}).x;
    worst = std::max(worst, (x.segment<3>(index::east) - frame.to_enu(g)).norm());
  }
  EXPECT_GT(x.head<2>().norm(), 8e3);
  EXPECT_LT(worst, 1.0);  // 0.01 % of the distance; without the Earth rate it would be 75 m
}

TEST(ProcessNoise, IsPositiveSemiDefiniteAndGrowsWhenSilent) {
  const FusionParameters parameters;
  const LocalEarth earth(test_origin());
  const StateVector x = busy_state();
  const auto noise = [&](const InertialInput& input) {
    return process_noise(x, mechanize(x, input, earth, parameters), input, parameters);
  };
  const StateMatrix heard = noise(some_input()), silent = noise(some_input(false));
  EXPECT_GE(least_eigenvalue(heard), -1e-15);
  EXPECT_GE(least_eigenvalue(noise(full_input())), -1e-15);
  EXPECT_GT(silent(index::azimuth, index::azimuth), 100.0 * heard(index::azimuth, index::azimuth));
  EXPECT_GT(silent(index::speed, index::speed), 10.0 * heard(index::speed, index::speed));
}

// Ten short steps and one long step must give the same covariance.
TEST(Predict, CovarianceDoesNotDependOnTheStep) {
  const LocalEarth earth(test_origin());
  const FusionParameters parameters;
  FilterState once, often;
  once.x = often.x = busy_state();
  once.P = often.P = busy_covariance();
  InertialInput input = some_input();
  input.yaw_rate = 0.1;
  predict(once, input, earth, parameters);
  input.duration /= 10.0;
  input.unseen_change /= 10.0;
  for (int i = 0; i < 10; ++i) predict(often, input, earth, parameters);
  const StateVector sigma = often.P.diagonal().cwiseSqrt();
  const StateMatrix difference =
      sigma.cwiseInverse().asDiagonal() * (once.P - often.P) * sigma.cwiseInverse().asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 2e-3);
}

}  // namespace
}  // namespace maploop::fusion
