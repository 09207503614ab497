// Tests the statistics of lasting contradictions: on made-up innovations, and on a synthetic drive
// whose sensors begin to lie by a little.
#include "estimators/fusion/contradiction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/drawn.h"

namespace maploop::fusion {
namespace {

using std::chrono::milliseconds;

constexpr Time start = from_nanoseconds(1'000'000'000'000);
constexpr double memory = 10.0;  // s

// The largest statistic of 1000 s at 10 Hz, with white innovations of this mean.
double largest(double mean) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  LastingError lasting;
  double most = 0.0;
  for (int i = 0; i < 10'000; ++i) {
    lasting.add({normal(random) + mean, 0.0}, start + i * milliseconds(100), memory);
    most = std::max(most, lasting.mean());
  }
  return most;
}

TEST(LastingError, IsChiSquareOfInnovationsWithoutAMean) {
  EXPECT_LT(largest(0.0), 16.0) << "a tail of 6e-5, and about 100 independent values";
}

TEST(LastingError, GrowsWhereEveryInnovationIsALittleWrong) {
  EXPECT_GT(largest(0.7), 50.0) << "0.49 of each of 200 samples";
}

TEST(LastingError, ForgetsWithItsMemory) {
  LastingError lasting;
  for (int i = 0; i < 100; ++i) lasting.add({2.0, 0.0}, start + i * milliseconds(100), memory);
  EXPECT_GT(lasting.mean(), 200.0);
  for (int i = 100; i < 1100; ++i) lasting.add({0.0, 0.0}, start + i * milliseconds(100), memory);
  EXPECT_LT(lasting.mean(), 1e-3);
}

TEST(LastingError, OneOutlierIsNotLasting) {
  LastingError lasting;
  for (int i = 0; i < 100; ++i)
    lasting.add({i == 50 ? 1e9 : 0.0, 0.0}, start + i * milliseconds(100), memory);
  EXPECT_LT(lasting.mean(), 1.0);
}

TEST(LastingError, OppositeErrorsOfTwoAxesDoNotCancel) {
  LastingError lasting;
  for (int i = 0; i < 20; ++i) lasting.add({1.5, -1.5}, start + i * milliseconds(1000), memory);
  EXPECT_GT(lasting.mean(), 50.0);
}

TEST(LastingError, NoiseThatIsLargerThanItsCovarianceScatters) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  LastingError honest, noisy;
  for (int i = 0; i < 1000; ++i) {
    const auto u = maploop::testing::drawn<Eigen::Vector2d>([&] { return normal(random); });
    honest.add(u, start + i * milliseconds(100), memory);
    noisy.add(3.0 * u, start + i * milliseconds(100), memory);
  }
  EXPECT_NEAR(honest.scatter(), 2.0, 0.5);
  EXPECT_GT(noisy.scatter(), 6.0);
  EXPECT_LT(noisy.mean(), 30.0);
}

TEST(LastingError, AFewInnovationsAreNoScatter) {
  LastingError error;
  for (int i = 0; i < 4; ++i) error.add({4.0, 0.0}, start + i * milliseconds(100), memory);
  EXPECT_EQ(error.scatter(), 0.0);
}

TEST(LastingError, BeforeTheFirstSampleNothingContradicts) {
  EXPECT_EQ(LastingError{}.mean(), 0.0);
}

using namespace maploop::testing;

// A drive of 40 s on a winding road; from 15 s on, the sensors may lie.
class LittleLie : public ::testing::Test {
 protected:
  static MotionProfile winding() {
    MotionProfile profile;
    profile.yaw_rate = [](double t) { return 0.2 * std::sin(t / 4.0); };
    return profile;
  }
  static bool lies(const Sample& s) { return s.stamp >= SyntheticDrive::at(15.0); }

  // Those that contradict at the end, in the order of Witness.
  std::vector<Witness> contradicting() {
    std::vector<Measurement> all = as_available(imu_, odometry_, drive_.fix(0.0));
    all.insert(all.end(), fixes_.begin(), fixes_.end());
    sort_as_available(all);
    const FusionParameters parameters = configured("GNSS+VO-RI");
    ReducedImuFilter filter(parameters, test_origin());
    states_after_odometry(filter, all);
    std::vector<Witness> those;
    for (int i = 0; i < static_cast<int>(Witness::count); ++i) {
      const auto witness = static_cast<Witness>(i);
      const bool motion = witness == Witness::motion_length || witness == Witness::motion_turn;
      if (filter.contradictions().of(witness).mean() >
          (motion ? parameters.doubt_motion_gate : parameters.doubt_gate))
        those.push_back(witness);
    }
    return those;
  }

  static std::vector<GnssFix> fixes_of(const SyntheticDrive& drive) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const LocalFrame frame(test_origin());
    std::vector<GnssFix> fixes;
    for (int i = 1; i < 40; ++i) {
      GnssFix fix = drive.fix(i);
      fix.sequence = static_cast<std::uint64_t>(i);
      for (int axis = 0; axis < 3; ++axis) fix.velocity_enu[axis] += 0.05 * normal(random);
      fixes.push_back(fix);
    }
    return fixes;
  }

  SyntheticDrive drive_{winding(), 40.0, test_origin()};
  SensorNoise noise_{.gyro_density = 8.7e-5,
                     .force_sigma = 0.2,
                     .odometry_speed_sigma = 0.02,
                     .odometry_rotation_sigma = 5e-4,
                     .seed = 7};
  std::vector<ImuSample> imu_ = drive_.imu(100.0, noise_);
  std::vector<RelativeMotion> odometry_ = drive_.odometry(10.0, noise_);
  std::vector<GnssFix> fixes_ = fixes_of(drive_);
};

TEST_F(LittleLie, SensorsThatAgreeContradictNothing) {
  EXPECT_TRUE(contradicting().empty());
}

TEST_F(LittleLie, OfAGyroThatGetsABiasShowsInTheTurningAndNotInTheLength) {
  for (ImuSample& s : imu_) s.yaw_rate += lies(s) ? radians(0.5) : 0.0;
  const auto those = contradicting();
  const auto has = [&](Witness w) { return std::count(those.begin(), those.end(), w) > 0; };
  EXPECT_TRUE(has(Witness::motion_turn));
  EXPECT_FALSE(has(Witness::motion_length));
}

TEST_F(LittleLie, OfAReceiverThatIsPulledAwayShowsInItsFixesAlone) {
  const LocalFrame frame(test_origin());
  for (GnssFix& fix : fixes_) {
    if (!lies(fix)) continue;
    const Eigen::Vector3d pull = Eigen::Vector3d::UnitX() * 0.5;
    fix.velocity_enu += pull;
    fix.position = frame.to_geodetic(frame.to_enu(fix.position) +
                                     to_seconds(fix.stamp - SyntheticDrive::at(15.0)) * pull);
  }
  const auto those = contradicting();
  ASSERT_FALSE(those.empty());
  for (const Witness witness : those) EXPECT_LE(witness, Witness::fix_velocity);
}

}  // namespace
}  // namespace maploop::fusion
