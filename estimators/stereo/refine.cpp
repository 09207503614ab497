#include "estimators/stereo/refine.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/stereo/adjustment.h"
#include "estimators/stereo/residual.h"

namespace maploop::stereo {
namespace {

// Perfect synthetic tracks have no residuals; their covariance must still be positive.
constexpr double smallest_variance_factor = 1e-12;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix6 prior_information(const MotionPrior& prior) {
  return prior.sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Performs one round with a fixed set of tracks; returns false if the equations have no finite
// solution.
bool levenberg_marquardt(const Adjustment& adjustment, const std::optional<MotionPrior>& prior,
                         std::span<const int> inliers, int max_iterations, Eigen::Isometry3d* pose,
                         int* iterations) {
  std::vector<double> disparities, tried_disparities;
  const auto prior_cost = [&](const Eigen::Isometry3d& at) {
    return prior ? prior->residual(at).squaredNorm() : 0.0;
  };
  double cost = adjustment.cost(*pose, inliers, &disparities) + prior_cost(*pose);
  double damping = 1e-6;
  for (int i = 0; i < max_iterations; ++i) {
    ++*iterations;
    const NormalEquations equations = adjustment.normal_equations(*pose, inliers, disparities);
    Matrix6 information = equations.information.topLeftCorner<6, 6>();
    Vector6 gradient = equations.gradient.head<6>();
    if (prior) {
      information += prior_information(*prior);
      gradient += prior->residual(*pose).cwiseQuotient(prior->sigma);
    }
    information.diagonal() *= 1.0 + damping;
    const Vector6 step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return false;
    const Eigen::Isometry3d tried = perturbed(*pose, step);
    const double tried_cost =
        adjustment.cost(tried, inliers, &tried_disparities) + prior_cost(tried);
    if (tried_cost <= cost) {
      const bool settled = cost - tried_cost <= 1e-7 * cost;
      *pose = tried;
      disparities.swap(tried_disparities);
      cost = tried_cost;
      damping *= 0.1;
      if (settled) break;
    } else {
      damping = std::max(damping * 100.0, 1e-3);
    }
  }
  return std::isfinite(cost);
}

// The covariance is the inverse information times the residuals' variance (Huber, "Robust
// Statistics", 1981, 7.6 in its simplest form), where each track has four residuals and one unknown
// disparity. It is also multiplied by the number of pairs that share their errors, so that
// covariances of successive motions may be added.
bool estimate_covariance(const Adjustment& adjustment, const std::optional<MotionPrior>& prior,
                         double correlated_pairs, double assumed_offset_sigma, Refinement* result) {
  const double freedom = 3.0 * static_cast<double>(result->inliers.size()) - 6.0;
  if (freedom <= 0.0) return false;
  std::vector<double> disparities;
  const Eigen::Isometry3d& pose = result->T_previous_current;
  const double cost = adjustment.cost(pose, result->inliers, &disparities);
  result->variance_factor = std::max(smallest_variance_factor, cost / freedom);  // (6) of METHOD.md
  const NormalEquations equations = adjustment.normal_equations(pose, result->inliers, disparities);

  const double variance = result->variance_factor * correlated_pairs;
  const Matrix6 of_tracks = equations.information.topLeftCorner<6, 6>();
  const Vector6 coupling = equations.information.topRightCorner<6, 1>();
  Matrix6 information = of_tracks / variance;
  if (prior) information += prior_information(*prior);
  const Eigen::LDLT<Matrix6> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return false;
  result->by_offset = -factor.solve(coupling) / variance;
  const Vector6 open = assumed_offset_sigma * result->by_offset;
  // (7) of METHOD.md
  const Matrix6 covariance = factor.solve(Matrix6::Identity()) + open * open.transpose();
  result->covariance = 0.5 * (covariance + covariance.transpose());

  // The offset is estimated from the tracks alone, with the pose eliminated.
  const Eigen::LDLT<Matrix6> tracks_factor(of_tracks);
  const double offset_information =
      equations.information(6, 6) - coupling.dot(tracks_factor.solve(coupling));
  const double gradient =
      equations.gradient[6] - coupling.dot(tracks_factor.solve(equations.gradient.head<6>()));
  const bool seen = tracks_factor.isPositive() && offset_information > 0.0;
  result->offset = seen ? -gradient / offset_information : 0.0;
  result->offset_sigma =
      seen ? std::sqrt(variance / offset_information) : std::numeric_limits<double>::infinity();
  return result->covariance.allFinite() && (result->covariance.diagonal().array() > 0.0).all() &&
         std::isfinite(result->offset);
}

std::vector<int> judge_tracks(const Adjustment& adjustment, const Eigen::Isometry3d& pose,
                              int count, double outlier_sigmas) {
  std::vector<int> inliers;
  double disparity = 0.0;
  for (int i = 0; i < count; ++i) {
    if (adjustment.settle(pose, i, &disparity) < outlier_sigmas * outlier_sigmas)
      inliers.push_back(i);
  }
  return inliers;
}

}  // namespace

Refinement refine_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                         std::span<const StereoTrack> tracks, std::span<const int> inliers,
                         const Eigen::Isometry3d& T_previous_current, double assumed_offset_sigma,
                         const std::optional<MotionPrior>& prior) {
  Refinement result;
  result.T_previous_current = T_previous_current;
  const Adjustment adjustment(camera, parameters, tracks);
  const auto adjust = [&](std::span<const int> chosen) {
    return chosen.size() >= 3 &&
           levenberg_marquardt(adjustment, prior, chosen, parameters.refine_max_iterations,
                               &result.T_previous_current, &result.iterations);
  };
  if (!adjust(inliers)) return result;
  result.inliers = judge_tracks(adjustment, result.T_previous_current,
                                static_cast<int>(tracks.size()), parameters.outlier_sigmas);
  result.ok =
      adjust(result.inliers) && estimate_covariance(adjustment, prior, parameters.correlated_pairs,
                                                    assumed_offset_sigma, &result);
  return result;
}

}  // namespace maploop::stereo
