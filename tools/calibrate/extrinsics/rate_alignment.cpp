#include "tools/calibrate/extrinsics/rate_alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "msgs/small_turn.h"
#include "tools/calibrate/extrinsics/robust_fit.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr int least_motions = 20;
constexpr double least_duration = 6.0;  // s
constexpr double least_correlation = 0.35;
constexpr double least_rate = 0.002;    // rad/s rms, below which a vehicle does not turn
constexpr double block_length = 2.0;    // s, longer than errors of odometry are correlated
constexpr double difference = 0.005;    // s, for the slope over time
constexpr double longest_search = 0.5;  // s
constexpr int iterations = 12;

struct Pair {
  Vector3d a, b;  // rad/s
};

std::vector<Pair> pairs_at(const RotationStream& a, std::span<const SensorMotion> b, double delay) {
  std::vector<Pair> pairs;
  for (const SensorMotion& m : b)
    if (const auto rate = a.mean_rate(m.from, m.to, delay)) pairs.push_back({*rate, m.rate()});
  return pairs;
}

struct Likeness {
  double value = 0.0;
  Matrix3d R_a_b = Matrix3d::Identity();
};

// Shortens the rates that are longer than four medians: a wild motion would outweigh all others.
void limit(std::vector<Pair>& pairs, Vector3d Pair::*which) {
  std::vector<double> sizes;
  sizes.reserve(pairs.size());
  for (const Pair& p : pairs) sizes.push_back((p.*which).norm());
  const double most = 4.0 * median_size(std::move(sizes));
  for (Pair& p : pairs) {
    const double size = (p.*which).norm();
    if (size > most) p.*which *= most / size;
  }
}

Likeness likeness(std::vector<Pair> pairs) {
  limit(pairs, &Pair::a);
  limit(pairs, &Pair::b);
  Pair mean{Vector3d::Zero(), Vector3d::Zero()};
  const double share = 1.0 / static_cast<double>(pairs.size());
  for (const Pair& p : pairs) {
    mean.a += share * p.a;
    mean.b += share * p.b;
  }
  Matrix3d sum = Matrix3d::Zero();
  double a = 0.0, b = 0.0;
  for (const Pair& p : pairs) {
    sum += (p.a - mean.a) * (p.b - mean.b).transpose();
    a += (p.a - mean.a).squaredNorm();
    b += (p.b - mean.b).squaredNorm();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  if (a * b <= 0.0) return {};
  return {svd.singularValues().dot(signs) / std::sqrt(a * b),
          svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()};
}

double turning(std::span<const SensorMotion> b) {
  double sum = 0.0;
  for (const SensorMotion& m : b) sum += m.rate().squaredNorm();
  return std::sqrt(sum / static_cast<double>(b.size()));
}

// Linearizes about the current estimate. The unknowns are a turn of R_a_b, the delay and the bias.
// The residual is in b's axes, those of the noisier sensor: its noise then has the same weights
// whatever the rotation, and does not pull it. A vertical rate alone can only be compared in a's.
std::vector<Equation> equations_at(const RotationStream& a, std::span<const SensorMotion> b,
                                   const RateAlignment& now, bool delay_by_third_axis) {
  std::vector<Equation> equations;
  for (const SensorMotion& m : b) {
    const auto rate = a.mean_rate(m.from, m.to, now.delay);
    const auto before = a.mean_rate(m.from, m.to, now.delay - difference);
    const auto after = a.mean_rate(m.from, m.to, now.delay + difference);
    if (!rate || !before || !after) continue;
    const Vector3d unbiased = *rate - now.bias;
    Eigen::Matrix<double, 3, 7> J;
    J << -cross_matrix(unbiased), -(*after - *before) / (2.0 * difference), Matrix3d::Identity();
    const Vector3d residual = unbiased - now.R_a_b * m.rate();
    const int block = static_cast<int>(to_seconds(m.from - b.front().from) / block_length);
    if (a.vertical_alone()) {
      J.leftCols<3>() = -cross_matrix(now.R_a_b * m.rate());
      equations.push_back({J.bottomRows<1>(), residual.tail<1>(), block});
    } else {
      const Matrix3d R_b_a = now.R_a_b.transpose();
      J = R_b_a * J;
      if (delay_by_third_axis) J.col(3).head<2>().setZero();
      equations.push_back({J, R_b_a * residual, block});
    }
  }
  return equations;
}

// Improves an estimate until it is settled. Returns its cost.
double settle(const RotationStream& a, std::span<const SensorMotion> b, const AlignmentStart& start,
              RateAlignment& now) {
  Eigen::VectorXd sigma(7);
  sigma << Vector3d::Constant(start.rotation_sigma), start.delay_sigma,
      Vector3d::Constant(std::max(1e-9, start.bias_sigma));
  Fit fit;
  for (int i = 0; i < iterations; ++i) {
    const std::vector<Equation> equations = equations_at(a, b, now, start.delay_by_third_axis);
    now.motions = static_cast<int>(equations.size());
    if (now.motions < least_motions) return std::numeric_limits<double>::infinity();
    Eigen::VectorXd from_prior(7);
    from_prior << turn_of(now.R_a_b * start.R_a_b.transpose()), now.delay, now.bias;
    fit = robust_fit(equations, from_prior, sigma);
    now.R_a_b = rotation_of(fit.step.head<3>()) * now.R_a_b;
    now.delay += std::clamp(fit.step[3], -0.05, 0.05);
    now.bias += fit.step.tail<3>();
  }
  now.covariance = fit.covariance;
  now.noise.tail(fit.noise.size()) = fit.noise;
  return fit.cost;
}

}  // namespace

std::vector<RateCorrelation> correlate(const RotationStream& a, std::span<const SensorMotion> b,
                                       double most, double step) {
  std::vector<RateCorrelation> all;
  const int steps = static_cast<int>(std::floor(most / step + 0.5));
  for (int i = -steps; i <= steps; ++i) {
    std::vector<Pair> pairs = pairs_at(a, b, i * step);
    if (2 * pairs.size() < b.size() || pairs.empty()) continue;
    all.push_back({i * step, likeness(std::move(pairs)).value});
  }
  return all;
}

RateAlignment align(const RotationStream& a, std::span<const SensorMotion> b,
                    const AlignmentStart& start) {
  RateAlignment result;
  result.R_a_b = start.R_a_b;
  const auto correlations = correlate(a, b, longest_search);
  if (correlations.empty() || b.size() < least_motions ||
      to_seconds(b.back().to - b.front().from) < least_duration)
    return result;
  const RateCorrelation best = *std::ranges::max_element(correlations, {}, &RateCorrelation::value);
  result.correlation = best.value;
  result.status = turning(b) < least_rate          ? AlignmentStatus::no_turning
                  : best.value < least_correlation ? AlignmentStatus::unrelated
                                                   : AlignmentStatus::ok;
  if (result.status != AlignmentStatus::ok) return result;
  result.delay = best.delay;
  RateAlignment other = result;
  other.R_a_b = likeness(pairs_at(a, b, best.delay)).R_a_b;
  const double cost = settle(a, b, start, result);
  if (!a.vertical_alone() && settle(a, b, start, other) < cost) result = other;
  if (result.motions < least_motions) result.status = AlignmentStatus::too_short;
  return result;
}

}  // namespace maploop::extrinsics
