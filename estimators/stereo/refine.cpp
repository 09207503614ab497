#include "estimators/stereo/refine.h"

#include <algorithm>
#include <cmath>

#include "estimators/stereo/adjustment.h"

namespace maploop::stereo {
namespace {

// One round with a fixed set of tracks; false where the equations have no finite solution.
bool levenberg_marquardt(const Adjustment& adjustment, std::span<const int> inliers,
                         int max_iterations, SharedUnknowns* unknowns, int* iterations) {
  std::vector<double> disparities, tried_disparities;
  double cost =
      adjustment.cost(*unknowns, inliers, &disparities) + adjustment.prior_cost(*unknowns);
  double damping = 1e-6;
  for (int i = 0; i < max_iterations; ++i) {
    ++*iterations;
    NormalEquations equations = adjustment.normal_equations(*unknowns, inliers, disparities);
    equations.information(6, 6) += equations.prior;
    equations.information.diagonal() *= 1.0 + damping;
    const Vector7 step = -equations.information.ldlt().solve(equations.gradient);
    if (!step.allFinite()) return false;
    const SharedUnknowns tried = perturbed(*unknowns, step);
    const double tried_cost =
        adjustment.cost(tried, inliers, &tried_disparities) + adjustment.prior_cost(tried);
    if (tried_cost <= cost) {
      const bool settled = cost - tried_cost <= 1e-7 * cost;
      *unknowns = tried;
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

// Inverse information times the residuals' variance (Huber, "Robust Statistics", 1981, 7.6 in its
// simplest form): each track leaves four residuals less its own disparity.
bool estimate_covariance(const Adjustment& adjustment, const SharedUnknowns& unknowns,
                         Refinement* result) {
  const double freedom = 3.0 * static_cast<double>(result->inliers.size()) - 6.0;
  if (freedom <= 0.0) return false;
  std::vector<double> disparities;
  result->variance_factor =
      adjustment.cost(unknowns, result->inliers, &disparities) / freedom;
  if (!(result->variance_factor > 0.0)) result->variance_factor = 1e-12;
  const NormalEquations equations =
      adjustment.normal_equations(unknowns, result->inliers, disparities);
  Matrix7 information = equations.information / result->variance_factor;
  information(6, 6) += equations.prior;
  const Eigen::LDLT<Matrix7> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return false;
  Matrix7 covariance = factor.solve(Matrix7::Identity());
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  if (!covariance.allFinite() || !(covariance.diagonal().array() > 0.0).all()) return false;
  result->covariance = covariance.topLeftCorner<6, 6>();
  result->disparity_offset_sigma = std::sqrt(covariance(6, 6));
  return true;
}

std::vector<int> judge_tracks(const Adjustment& adjustment, const SharedUnknowns& unknowns,
                              int count, double outlier_sigmas) {
  std::vector<int> inliers;
  double disparity = 0.0;
  for (int i = 0; i < count; ++i)
    if (adjustment.settle(unknowns, i, &disparity) < outlier_sigmas * outlier_sigmas)
      inliers.push_back(i);
  return inliers;
}

}  // namespace

Refinement refine_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                         std::span<const StereoTrack> tracks, std::span<const int> inliers,
                         const Eigen::Isometry3d& T_previous_current, double offset_sigma) {
  Refinement result;
  SharedUnknowns unknowns{T_previous_current, 0.0};
  const Adjustment adjustment(camera, parameters, tracks, offset_sigma);
  if (inliers.size() < 3 ||
      !levenberg_marquardt(adjustment, inliers, parameters.refine_max_iterations, &unknowns,
                           &result.iterations))
    return result;
  result.inliers = judge_tracks(adjustment, unknowns, static_cast<int>(tracks.size()),
                                parameters.outlier_sigmas);
  if (result.inliers.size() < 3) return result;
  result.ok = levenberg_marquardt(adjustment, result.inliers, parameters.refine_max_iterations,
                                  &unknowns, &result.iterations) &&
              estimate_covariance(adjustment, unknowns, &result);
  result.T_previous_current = unknowns.T_previous_current;
  result.disparity_offset = unknowns.disparity_offset;
  return result;
}

}  // namespace maploop::stereo
