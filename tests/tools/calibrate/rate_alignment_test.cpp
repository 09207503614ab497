// Tests rotation and time offset of sensors that turn in a known way.
#include <gtest/gtest.h>

#include "msgs/frames.h"
#include "tests/tools/calibrate/made_motion.h"
#include "tools/calibrate/extrinsics/rate_alignment.h"
#include "tools/calibrate/extrinsics/robust_fit.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Vector3d;

const Eigen::Isometry3d tilted = placed(1.0, 0.3, 0.7, {0.03, -0.05, 0.06});

RotationStream gyros(const MadeMotion& motion, bool vertical_alone = false) {
  auto samples = motion.of_gyros(0.04, 1e-4, {0.002, -0.001, 0.003});
  if (vertical_alone)
    for (RateSample& s : samples) s.rate.head<2>().setZero();
  return RotationStream::of_rates(samples, vertical_alone);
}

double error_deg(const RateAlignment& r, const Eigen::Isometry3d& truth) {
  return degrees(turn_of(r.R_a_b * truth.linear().transpose()).norm());
}

TEST(RateAlignment, FindsRotationDelayAndBias) {
  const MadeMotion motion;
  const auto camera = motion.of_sensor(tilted, -0.02, 1e-4);
  const RateAlignment r = align(gyros(motion), camera, {});
  ASSERT_EQ(r.status, AlignmentStatus::ok);
  EXPECT_LT(error_deg(r, tilted), 0.2);
  EXPECT_NEAR(r.delay, 0.06, 0.002);
  EXPECT_LT((r.bias - Vector3d(0.002, -0.001, 0.003)).norm(), 2e-4);
  EXPECT_LT(degrees(r.rotation_sigma().maxCoeff()), 0.2);
}

TEST(RateAlignment, ItsSigmaIsThatOfItsErrors) {
  const MadeMotion motion({.seconds = 30.0});
  double squares = 0.0;
  constexpr int seeds = 20;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const RateAlignment r =
        align(gyros(motion), motion.of_sensor(tilted, 0.0, 3e-4, 0.0, seed), {});
    ASSERT_EQ(r.status, AlignmentStatus::ok);
    const Vector3d e = turn_of(r.R_a_b * tilted.linear().transpose());
    squares += e.dot(r.covariance.topLeftCorner<3, 3>().inverse() * e) / (3.0 * seeds);
  }
  EXPECT_GT(squares, 0.3);
  EXPECT_LT(squares, 1.6);
}

TEST(RateAlignment, AStartThatIsTurnedByARightAngleIsNoHindrance) {
  const MadeMotion motion;
  const Eigen::Isometry3d sideways = placed(0.0, 0.0, 0.0, {0.0, 0.0, 1.57});
  const RateAlignment r = align(gyros(motion), motion.of_sensor(sideways, 0.0, 1e-4), {});
  ASSERT_EQ(r.status, AlignmentStatus::ok);
  EXPECT_LT(error_deg(r, sideways), 0.5);
}

TEST(RateAlignment, OneMotionInTenMayBeWild) {
  const MadeMotion motion;
  auto camera = motion.of_sensor(tilted, 0.0, 1e-4);
  for (std::size_t i = 5; i < camera.size(); i += 10)
    camera[i].T_from_to.linear() = rotation_of({0.2, -0.1, 0.1}) * camera[i].T_from_to.linear();
  const RateAlignment r = align(gyros(motion), camera, {});
  ASSERT_EQ(r.status, AlignmentStatus::ok);
  EXPECT_LT(error_deg(r, tilted), 0.3);
  EXPECT_NEAR(r.delay, 0.04, 0.003);
}

TEST(RateAlignment, AStraightSmoothDriveIsNoTurning) {
  const MadeMotion motion({.turns = 0.0, .pitches = 0.0, .rolls = 0.0});
  EXPECT_EQ(align(gyros(motion), motion.of_sensor(tilted, 0.0, 1e-5), {}).status,
            AlignmentStatus::no_turning);
}

TEST(RateAlignment, NoiseAloneIsUnrelated) {
  const MadeMotion motion({.turns = 0.0, .pitches = 0.0, .rolls = 0.0});
  EXPECT_EQ(align(gyros(motion), motion.of_sensor(tilted, 0.0, 1e-3), {}).status,
            AlignmentStatus::unrelated);
}

TEST(RateAlignment, AFewSecondsAreTooShort) {
  const MadeMotion motion({.seconds = 5.0});
  EXPECT_EQ(align(gyros(motion), motion.of_sensor(tilted, 0.0, 1e-4), {}).status,
            AlignmentStatus::too_short);
}

TEST(RateAlignment, NoMotionAtAllIsTooShort) {
  EXPECT_EQ(align(RotationStream(), {}, {}).status, AlignmentStatus::too_short);
}

TEST(RateAlignment, WithoutPitchAndRollTheTurnAboutTheVerticalIsNotSeen) {
  const MadeMotion motion({.pitches = 0.0, .rolls = 0.0});
  const RateAlignment r = align(gyros(motion), motion.of_sensor(tilted, 0.0, 1e-4), {});
  ASSERT_EQ(r.status, AlignmentStatus::ok);
  EXPECT_GT(degrees(r.rotation_sigma().z()), 1.0);
  EXPECT_LT(degrees(r.rotation_sigma().head<2>().maxCoeff()), 0.3);
}

TEST(RateAlignment, OneGyroSeesTheVerticalAxisAndNotTheTurnAboutIt) {
  const MadeMotion motion;
  const RateAlignment r = align(gyros(motion, true), motion.of_sensor(tilted, 0.0, 1e-4), {});
  ASSERT_EQ(r.status, AlignmentStatus::ok);
  EXPECT_GT(degrees(r.rotation_sigma().z()), 5.0);
  const Vector3d up = r.R_a_b.transpose() * Vector3d::UnitZ();
  const Vector3d truth = tilted.linear().transpose() * Vector3d::UnitZ();
  EXPECT_LT(degrees(std::acos(up.dot(truth))), 0.3);
  EXPECT_NEAR(r.delay, 0.04, 0.005);
}

TEST(RotationStream, NoMeanReachesAcrossAGap) {
  auto samples = MadeMotion({.seconds = 10.0}).of_gyros(0.0);
  const Time first = samples.front().stamp;
  samples.erase(samples.begin() + 400, samples.begin() + 500);
  const RotationStream stream = RotationStream::of_rates(samples, false);
  const auto at = [first](double t) { return first + from_seconds(t); };
  EXPECT_TRUE(stream.mean_rate(at(3.0), at(3.5), 0.0));
  EXPECT_FALSE(stream.mean_rate(at(3.8), at(4.2), 0.0));
  EXPECT_FALSE(stream.mean_rate(at(3.8), at(5.2), 0.0));
  EXPECT_TRUE(stream.mean_rate(at(3.8), at(4.2), -0.5));
  EXPECT_FALSE(stream.mean_rate(at(9.8), at(10.2), 0.0)) << "beyond the end";
}

TEST(RotationStream, SamplesAndMotionsGiveTheMeanRate) {
  const MadeMotion motion({.seconds = 10.0});
  const auto motions = motion.of_sensor(Eigen::Isometry3d::Identity(), 0.0);
  const auto by_samples = RotationStream::of_rates(motion.of_gyros(0.0), false);
  const auto by_motions = RotationStream::of_motions(motions);
  for (std::size_t i = 10; i < 80; i += 10) {
    const SensorMotion& m = motions[i];
    EXPECT_LT((*by_samples.mean_rate(m.from, m.to, 0.0) - m.rate()).norm(), 2e-4);
    EXPECT_LT((*by_motions.mean_rate(m.from, m.to, 0.0) - m.rate()).norm(), 1e-9);
    EXPECT_LT(
        (*by_motions.mean_rate(m.from, m.to, 0.04) - *by_samples.mean_rate(m.from, m.to, 0.04))
            .norm(),
        0.01);
  }
}

TEST(RobustFit, ErrorsThatAreTheSameWithinABlockAreNotCountedAsMany) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal;
  std::vector<Equation> equations;
  for (int block = 0; block < 30; ++block) {
    const double common = normal(engine);
    for (int i = 0; i < 40; ++i) {
      Equation e;
      e.jacobian = Eigen::Matrix<double, 1, 1>(1.0);
      e.residual = Eigen::Matrix<double, 1, 1>(5.0 + common + 0.3 * normal(engine));
      e.block = block;
      equations.push_back(e);
    }
  }
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(1), wide = Eigen::VectorXd::Constant(1, 100.0);
  const Fit fit = robust_fit(equations, none, wide);
  const double sigma = std::sqrt(fit.covariance(0, 0));
  EXPECT_NEAR(sigma, 1.0 / std::sqrt(30.0), 0.06) << "as of 30 errors; of 1200 it would be 0.03";
  EXPECT_LT(std::abs(fit.step[0] - 5.0), 3.0 * sigma);
}

}  // namespace
}  // namespace maploop::extrinsics
