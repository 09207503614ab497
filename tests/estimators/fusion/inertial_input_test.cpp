#include "estimators/fusion/inertial_input.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using maploop::testing::SyntheticDrive;

ImuSample sample(double t, double rate, double force) {
  ImuSample s;
  s.stamp = SyntheticDrive::at(t);
  s.yaw_rate = rate;
  s.specific_force_forward = force;
  return s;
}

TEST(InertialInput, InterpolatesBetweenSamples) {
  const ImuSample a = sample(1.0, 0.2, 1.0), b = sample(1.1, 0.4, 3.0);
  const InertialInput input =
      inertial_input({&a, &b}, SyntheticDrive::at(1.02), SyntheticDrive::at(1.04), {});
  EXPECT_TRUE(input.inertial);
  EXPECT_NEAR(input.duration, 0.02, 1e-12);
  EXPECT_NEAR(input.yaw_rate, 0.26, 1e-12);
  EXPECT_NEAR(input.forward_force, 1.6, 1e-12);
}

TEST(InertialInput, HoldsTheNewestSampleAndDoubtsItMoreAndMore) {
  const ImuSample a = sample(1.0, 0.2, 1.0);
  const InertialInput early =
      inertial_input({&a, nullptr}, SyntheticDrive::at(1.0), SyntheticDrive::at(1.05), {});
  const InertialInput late =
      inertial_input({&a, nullptr}, SyntheticDrive::at(1.2), SyntheticDrive::at(1.25), {});
  EXPECT_EQ(late.yaw_rate, 0.2);
  EXPECT_EQ(late.forward_force, 1.0);
  EXPECT_GT(late.unseen_change, 10.0 * early.unseen_change);
}

TEST(InertialInput, IsSilentWithoutASampleAndAfterTheHold) {
  EXPECT_FALSE(inertial_input({}, SyntheticDrive::at(1.0), SyntheticDrive::at(1.05), {}).inertial);
  const ImuSample a = sample(1.0, 0.2, 1.0), after_a_long_gap = sample(3.5, 0.4, 1.0);
  const FusionParameters parameters;
  const Time hold_ends =
      end_of_stretch({&a, nullptr}, SyntheticDrive::at(1.28), SyntheticDrive::at(1.32), parameters);
  EXPECT_EQ(hold_ends, SyntheticDrive::at(1.0) + from_seconds(parameters.imu_hold));
  EXPECT_FALSE(
      inertial_input({&a, nullptr}, hold_ends, SyntheticDrive::at(1.32), parameters).inertial);
  EXPECT_FALSE(inertial_input({&a, &after_a_long_gap}, SyntheticDrive::at(2.0),
                              SyntheticDrive::at(2.05), parameters)
                   .inertial);
}

TEST(InertialInput, BridgesAShortGapWithADoubtThatGrowsWithIt) {
  const ImuSample a = sample(1.0, 0.6, 1.0), b = sample(2.6, 0.2, 1.0);
  const FusionParameters parameters;
  double turned = 0.0, unseen = 0.0;
  for (Time t = SyntheticDrive::at(1.0); t < SyntheticDrive::at(2.6);) {
    const Time end = end_of_stretch({&a, &b}, t, SyntheticDrive::at(2.6), parameters);
    const InertialInput input = inertial_input({&a, &b}, t, end, parameters);
    ASSERT_TRUE(input.inertial);
    turned += input.yaw_rate * input.duration;
    unseen += input.unseen_change;
    t = end;
  }
  EXPECT_NEAR(turned, 0.4 * 1.6, 1e-9);
  EXPECT_NEAR(std::sqrt(unseen), 1.6 * 1.6 / 8.0, 1e-9) << "a triangle on the gap";
}

TEST(InertialInput, StretchesAreNoLongerThanTheStep) {
  const ImuSample a = sample(1.0, 0.2, 1.0), b = sample(1.2, 0.4, 3.0);
  FusionParameters parameters;
  parameters.max_step = 0.05;
  EXPECT_EQ(end_of_stretch({&a, &b}, SyntheticDrive::at(1.0), SyntheticDrive::at(1.2), parameters),
            SyntheticDrive::at(1.05));
  EXPECT_EQ(end_of_stretch({&a, &b}, SyntheticDrive::at(1.18), SyntheticDrive::at(1.2), parameters),
            SyntheticDrive::at(1.2));
}

}  // namespace
}  // namespace maploop::fusion
