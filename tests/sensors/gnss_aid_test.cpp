#include "sensors/replay/gnss_aid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sensors/replay/normal_generator.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;

const Geodetic here{0.855, 0.147, 114.0};
const Eigen::Vector3d velocity(3.0, -4.0, 0.1);
const Time start = parse_time("2011-09-26 13:10:51.175862102");

// Returns `fixes` fixes of a standing vehicle, offered at the aid's own rate.
std::vector<GnssFix> run(const GnssAidParameters& parameters, int fixes) {
  GnssAid aid(parameters);
  std::vector<GnssFix> result(static_cast<std::size_t>(fixes));
  for (int k = 0; k < fixes; ++k) {
    const Time stamp = start + k * from_seconds(1.0 / parameters.rate);
    EXPECT_TRUE(aid.offer(stamp, here, velocity, result[static_cast<std::size_t>(k)]));
  }
  return result;
}

Eigen::Vector3d error_enu(const GnssFix& fix) {
  return LocalFrame(here).to_enu(fix.position);
}

TEST(NormalGenerator, HasTheMomentsOfANormalDistribution) {
  NormalGenerator generator(1, start);
  constexpr int n = 200000;
  double sum = 0, sum2 = 0, sum4 = 0, beyond2 = 0;
  for (int i = 0; i < n; ++i) {
    const double x = generator.next();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    beyond2 += std::fabs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / n, 0.0, 0.007);
  EXPECT_NEAR(sum2 / n, 1.0, 0.01);
  EXPECT_NEAR(sum4 / n, 3.0, 0.08);
  EXPECT_NEAR(beyond2 / n, 0.0455, 0.0015);
}

// The numbers were computed independently of the code, with splitmix64 and the standard's Mersenne
// twister in another language.
TEST(NormalGenerator, FirstNumbersOfOneSeedAndStamp) {
  NormalGenerator generator(1, from_nanoseconds(1317042651175862102));
  EXPECT_NEAR(generator.next(), -1.0812091577209, 1e-12);
  EXPECT_NEAR(generator.next(), -1.0922022663614028, 1e-12);
  EXPECT_NEAR(generator.next(), -0.40148090519253243, 1e-12);
}

TEST(NormalGenerator, NeighbouringSeedsAndStampsAreUncorrelated) {
  double seeds = 0, stamps = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    seeds += NormalGenerator(seed, start).next() * NormalGenerator(seed + 1, start).next();
    stamps += NormalGenerator(1, start + Duration(i)).next() *
              NormalGenerator(1, start + Duration(i + 1)).next();
  }
  EXPECT_NEAR(seeds / n, 0.0, 0.02);
  EXPECT_NEAR(stamps / n, 0.0, 0.02);
}

// With white noise of 1 m and Gauss-Markov noise of 1.5 m / 30 s, the covariance of two fixes k
// seconds apart is 1 [k = 0] + 1.5^2 exp(-k / 30) for each axis, and 0 between axes.
TEST(GnssAid, PositionNoiseHasTheVarianceAndCorrelationItStates) {
  constexpr int seeds = 4000, fixes = 16;
  const int lags[] = {0, 1, 5, 15};
  Eigen::Matrix<double, 3, 4> covariance = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  for (int seed = 0; seed < seeds; ++seed) {
    GnssAidParameters parameters;
    parameters.seed = seed;
    const std::vector<GnssFix> run_of_seed = run(parameters, fixes);
    const Eigen::Vector3d first = error_enu(run_of_seed[0]);
    const Eigen::Vector3d last = error_enu(run_of_seed[fixes - 1]);
    mean += last / seeds;
    across += last * last.transpose() / seeds;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d e = error_enu(run_of_seed[static_cast<std::size_t>(lags[i])]);
      covariance.col(i) += first.cwiseProduct(e) / seeds;
    }
  }
  // One standard deviation of a variance over 4000 seeds is 2.2 %: 0.07 m^2.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean(axis), 0.0, 0.1);
    EXPECT_NEAR(across(axis, axis), 3.25, 0.2);
    EXPECT_NEAR(across(axis, (axis + 1) % 3), 0.0, 0.15);
    for (int i = 0; i < 4; ++i) {
      const double expected = (lags[i] == 0 ? 1.0 : 0.0) + 2.25 * std::exp(-lags[i] / 30.0);
      EXPECT_NEAR(covariance(axis, i), expected, 0.2) << "axis " << axis << " lag " << lags[i];
    }
  }
}

TEST(GnssAid, VelocityNoiseIsWhiteWithItsStatedVariance) {
  constexpr int seeds = 4000;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero(), lag1 = Eigen::Vector3d::Zero();
  for (int seed = 0; seed < seeds; ++seed) {
    GnssAidParameters parameters;
    parameters.seed = seed;
    const std::vector<GnssFix> fixes = run(parameters, 2);
    const Eigen::Vector3d a = fixes[0].velocity_enu - velocity,
                          b = fixes[1].velocity_enu - velocity;
    variance += a.cwiseProduct(a) / seeds;
    lag1 += a.cwiseProduct(b) / seeds;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(variance(axis), 0.01, 0.0006);
    EXPECT_NEAR(lag1(axis), 0.0, 0.0005);
  }
}

TEST(GnssAid, StatesItsCovariances) {
  const GnssFix fix = run({}, 1)[0];
  EXPECT_LT((fix.position_covariance - 3.25 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((fix.velocity_covariance - 0.01 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(GnssAid, DrawnSizesAreOfTheirRangesAndFixesSayTheGivenOnes) {
  constexpr int seeds = 1000;
  double times = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    GnssAidParameters parameters;
    parameters.errors = ErrorModel::drawn;
    parameters.seed = seed;
    const GnssErrors drawn = errors_of(parameters);
    EXPECT_GE(drawn.white_position, 0.3);
    EXPECT_LE(drawn.white_position, 1.5);
    EXPECT_GE(drawn.markov_position, 0.7 * 1.5);
    EXPECT_LE(drawn.markov_position, 2.0 * 1.5);
    EXPECT_GE(drawn.markov_time, 5.0);
    EXPECT_LE(drawn.markov_time, 600.0);
    EXPECT_GE(drawn.white_velocity, 0.05);
    EXPECT_LE(drawn.white_velocity, 0.2);
    EXPECT_GE(drawn.step_share, 0.0);
    EXPECT_LE(drawn.step_share, 0.05);
    times += std::log(drawn.markov_time) / seeds;
    const auto fixes = run(parameters, 2), again = run(parameters, 2);
    EXPECT_EQ(fixes[1].position.latitude, again[1].position.latitude);
    EXPECT_LT((fixes[1].position_covariance - 3.25 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT((fixes[1].velocity_covariance - 0.01 * Eigen::Matrix3d::Identity()).norm(), 1e-12);
  }
  EXPECT_NEAR(times, 0.5 * (std::log(5.0) + std::log(600.0)), 0.15);
}

// Only the steps have an effect: everything else is without noise.
TEST(GnssAid, DrawnStepsAreOfTheirShareAndLastForTenSeconds) {
  double inside = 0.0, expected = 0.0, steps = 0.0, squares = 0.0;
  constexpr int seeds = 200, fixes = 2000;
  for (int seed = 0; seed < seeds; ++seed) {
    GnssAidParameters parameters;
    parameters.errors = ErrorModel::drawn;
    parameters.white_position = parameters.markov_position = 0.0;
    parameters.seed = seed;
    expected += fixes * errors_of(parameters).step_share;
    double before = 0.0;
    for (const GnssFix& fix : run(parameters, fixes)) {
      const Eigen::Vector3d error = error_enu(fix);
      const bool in_step = error.norm() > 1e-6;
      if (in_step && before != error.x()) {
        ++steps;
        squares += error.squaredNorm() / 3.0;
      }
      before = in_step ? error.x() : 0.0;
      inside += in_step ? 1.0 : 0.0;
    }
  }
  EXPECT_NEAR(inside / expected, 1.0, 0.1);
  EXPECT_NEAR(inside / steps, 10.0, 1.5);
  EXPECT_NEAR(std::sqrt(squares / steps), 10.0, 0.5);
}

TEST(GnssAid, OneSeedGivesTheSameBitsAndAnotherSeedOthers) {
  GnssAidParameters other;
  other.seed = 2;
  const auto a = run({}, 10), b = run({}, 10), c = run(other, 10);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_EQ(a[k].position.latitude, b[k].position.latitude);
    EXPECT_EQ(a[k].position.height, b[k].position.height);
    EXPECT_EQ(a[k].velocity_enu, b[k].velocity_enu);
    EXPECT_NE(a[k].position.latitude, c[k].position.latitude);
    EXPECT_NE(a[k].velocity_enu, c[k].velocity_enu);
  }
}

TEST(GnssAid, NeverGivesTheReferenceItself) {
  for (const GnssFix& fix : run({}, 200)) {
    EXPECT_NE(fix.position.latitude, here.latitude);
    EXPECT_NE(fix.position.longitude, here.longitude);
    EXPECT_NE(fix.position.height, here.height);
    EXPECT_GT((fix.velocity_enu - velocity).norm(), 1e-4);
  }
}

TEST(GnssAid, TakesTheFirstOfferAtOrAfterEachPeriod) {
  GnssAid aid({});
  GnssFix fix;
  std::vector<int> taken;
  for (const int ms : {0, 100, 999, 1099, 1900, 1999, 2000, 2100, 3050}) {
    if (aid.offer(start + milliseconds(ms), here, velocity, fix)) {
      taken.push_back(ms);
      EXPECT_EQ(fix.sequence, taken.size() - 1);
      EXPECT_EQ(fix.stamp, start + milliseconds(ms));
    }
  }
  EXPECT_EQ(taken, (std::vector<int>{0, 1099, 2000, 3050}));
}

TEST(GnssAid, APeriodWithoutAnyOfferIsAGapInTheSequence) {
  GnssAid aid({});
  GnssFix fix;
  ASSERT_TRUE(aid.offer(start, here, velocity, fix));
  ASSERT_TRUE(aid.offer(start + milliseconds(3200), here, velocity, fix));
  EXPECT_EQ(fix.sequence, 3U);
  EXPECT_FALSE(aid.offer(start + milliseconds(3900), here, velocity, fix));
  EXPECT_TRUE(aid.offer(start + milliseconds(4000), here, velocity, fix));
}

TEST(GnssAid, RefusesParametersWithoutMeaning) {
  const double bad[] = {-1.0, std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity()};
  for (const auto member : {&GnssAidParameters::rate, &GnssAidParameters::white_position,
                            &GnssAidParameters::markov_position, &GnssAidParameters::markov_time,
                            &GnssAidParameters::white_velocity}) {
    for (const double value : bad) {
      GnssAidParameters parameters;
      parameters.*member = value;
      EXPECT_THROW(GnssAid{parameters}, std::invalid_argument);
    }
  }
  GnssAidParameters zero;
  zero.markov_time = 0.0;
  EXPECT_THROW(GnssAid{zero}, std::invalid_argument);
}

}  // namespace
}  // namespace maploop::sensors
