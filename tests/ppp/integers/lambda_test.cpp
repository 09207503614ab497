// Tests the search for integers against a published example and against all candidates nearby.
#include "ppp/integers/lambda.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace maploop::ppp {
namespace {

double distance(const Lambda::Vector& a, const Lambda::Matrix& Q, const Lambda::Vector& integers) {
  const Lambda::Vector off = a - integers;
  return off.dot(Q.ldlt().solve(off));
}

// Returns the original integers of those of the decorrelated ambiguities: a = Z^-T z.
Lambda::Vector original(const Lambda& lambda, const Lambda::Vector& z) {
  const Eigen::MatrixXd Zt = lambda.transformation().transpose();
  return Zt.partialPivLu().solve(Eigen::VectorXd(z)).array().round().matrix();
}

// The example of de Jonge and Tiberius, "The LAMBDA method for integer ambiguity estimation:
// implementation aspects", LGR series 12, Delft, 1996.
TEST(Lambda, FindsThePublishedIntegers) {
  Lambda::Matrix Q(3, 3);
  Q << 6.290, 5.978, 0.544, 5.978, 6.292, 2.340, 0.544, 2.340, 6.288;
  Lambda::Vector a(3);
  a << 5.450, 3.100, 2.970;
  Lambda lambda;
  ASSERT_TRUE(lambda.decorrelate(a, Q));
  const auto found = lambda.search(3);
  ASSERT_TRUE(found);
  const Lambda::Vector best = original(lambda, found->integers);
  EXPECT_EQ(best[0], 5.0);
  EXPECT_EQ(best[1], 3.0);
  EXPECT_EQ(best[2], 4.0);
  EXPECT_NEAR(found->distance, 0.2183, 1e-3);
  EXPECT_NEAR(found->next_distance, 0.3073, 1e-3);
}

TEST(Lambda, NoOtherIntegersNearbyAreCloser) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 4;
    Lambda::Matrix H(n, n);
    for (int i = 0; i < n * n; ++i) H(i / n, i % n) = normal(random);
    const Lambda::Matrix Q = 0.3 * H * H.transpose() + 0.01 * Lambda::Matrix::Identity(n, n);
    Lambda::Vector a(n);
    for (int i = 0; i < n; ++i) a[i] = 3.0 * normal(random);
    Lambda lambda;
    ASSERT_TRUE(lambda.decorrelate(a, Q));
    const auto found = lambda.search(n);
    ASSERT_TRUE(found);
    EXPECT_NEAR(distance(a, Q, original(lambda, found->integers)), found->distance, 1e-6);
    double best = std::numeric_limits<double>::infinity(), next = best;
    constexpr int reach = 4;
    const Lambda::Vector middle = a.array().round();
    for (int code = 0; code < std::pow(2 * reach + 1, n); ++code) {
      Lambda::Vector integers = middle;
      for (int i = 0, rest = code; i < n; ++i, rest /= 2 * reach + 1)
        integers[i] += rest % (2 * reach + 1) - reach;
      const double d = distance(a, Q, integers);
      next = std::min(next, std::max(best, d));
      best = std::min(best, d);
    }
    EXPECT_LE(found->distance, best + 1e-9);
    EXPECT_LE(found->next_distance, next + 1e-9);
  }
}

TEST(Lambda, TransformationKeepsIntegersAndVolume) {
  Lambda::Matrix Q(3, 3);
  Q << 6.290, 5.978, 0.544, 5.978, 6.292, 2.340, 0.544, 2.340, 6.288;
  Lambda lambda;
  ASSERT_TRUE(lambda.decorrelate(Lambda::Vector::Zero(3), Q));
  const Eigen::Matrix3d Z = lambda.transformation();
  EXPECT_EQ(Z, Z.array().round().matrix());
  EXPECT_NEAR(std::abs(Z.determinant()), 1.0, 1e-12);
}

TEST(Lambda, FewerIntegersAreMoreCertain) {
  Lambda::Matrix Q = Lambda::Matrix::Identity(3, 3) * 0.01;
  Q(0, 0) = 0.25;
  Lambda lambda;
  ASSERT_TRUE(lambda.decorrelate(Lambda::Vector::Zero(3), Q));
  EXPECT_NEAR(lambda.success_rate(1), std::erf(0.5 / std::sqrt(0.02)), 1e-12);
  EXPECT_LT(lambda.success_rate(3), lambda.success_rate(2));
  EXPECT_NEAR(lambda.success_rate(3) / lambda.success_rate(2), std::erf(0.5 / std::sqrt(0.5)),
              1e-12);
}

TEST(Lambda, RefusesACovarianceThatIsNone) {
  Lambda lambda;
  Lambda::Matrix Q = Lambda::Matrix::Identity(2, 2);
  Q(1, 1) = -1.0;
  EXPECT_FALSE(lambda.decorrelate(Lambda::Vector::Zero(2), Q));
  Q(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(lambda.decorrelate(Lambda::Vector::Zero(2), Q));
}

}  // namespace
}  // namespace maploop::ppp
