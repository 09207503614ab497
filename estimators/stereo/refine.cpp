#include "estimators/stereo/refine.h"

#include <algorithm>
#include <cmath>

#include "estimators/stereo/residual.h"

namespace maploop::stereo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kSmallestDisparity = 0.05;  // px; keeps an adjusted point in front and finite

// One track's share of the problem: pose, and its own disparity at the previous epoch.
class Adjustment {
 public:
  Adjustment(const StereoCalibration& camera, const StereoParameters& parameters,
             std::span<const StereoTrack> tracks)
      : camera_(camera), parameters_(parameters), tracks_(tracks) {
    const double track_weight = 1.0 / parameters.sigma_track;
    disparity_weight_ = 1.0 / parameters.sigma_disparity;
    whitening_ = {track_weight, track_weight, disparity_weight_};
  }

  // Best disparity of a track for a given pose (two Gauss-Newton steps from the measured one), and
  // the squared whitened residual that is left. Infinite behind the camera.
  double settle(const Eigen::Isometry3d& pose, int track, double* disparity) const {
    *disparity = measured(track);
    for (int i = 0; i < 2; ++i) {
      const Term term = linearize(pose, track, *disparity);
      if (!term.valid) return std::numeric_limits<double>::infinity();
      *disparity = std::max(kSmallestDisparity, *disparity - term.by_disparity.dot(term.residual) /
                                                                 term.by_disparity.squaredNorm());
    }
    const Term term = linearize(pose, track, *disparity);
    return term.valid ? term.residual.squaredNorm() : std::numeric_limits<double>::infinity();
  }

  double huber_cost(double squared) const {
    const double k = parameters_.huber;
    return squared <= k * k ? squared : 2.0 * k * std::sqrt(squared) - k * k;
  }

  double huber_weight(double squared) const {
    const double k = parameters_.huber;
    return squared <= k * k ? 1.0 : k / std::sqrt(squared);
  }

  double cost(const Eigen::Isometry3d& pose, std::span<const int> inliers,
              std::vector<double>* disparities) const {
    disparities->resize(inliers.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < inliers.size(); ++i)
      sum += huber_cost(settle(pose, inliers[i], &(*disparities)[i]));
    return sum;
  }

  // Normal equations of the pose with the disparities eliminated.
  void normal_equations(const Eigen::Isometry3d& pose, std::span<const int> inliers,
                        const std::vector<double>& disparities, Matrix6* information,
                        Vector6* gradient) const {
    information->setZero();
    gradient->setZero();
    for (std::size_t i = 0; i < inliers.size(); ++i) {
      const Term term = linearize(pose, inliers[i], disparities[i]);
      if (!term.valid) continue;
      const double weight = huber_weight(term.residual.squaredNorm());
      const Vector6 coupling = term.by_pose.transpose() * term.by_disparity;
      const double own = term.by_disparity.squaredNorm();
      *information += weight * (term.by_pose.transpose() * term.by_pose -
                                coupling * coupling.transpose() / own);
      *gradient += weight * (term.by_pose.transpose() * term.residual -
                             coupling * (term.by_disparity.dot(term.residual) / own));
    }
  }

 private:
  // Whitened: current u, v, disparity, then the previous disparity.
  struct Term {
    bool valid = false;
    Eigen::Vector4d residual;
    Eigen::Matrix<double, 4, 6> by_pose;
    Eigen::Vector4d by_disparity;
  };

  double measured(int track) const {
    return tracks_[static_cast<std::size_t>(track)].previous.disparity();
  }

  Term linearize(const Eigen::Isometry3d& pose, int track, double disparity) const {
    const StereoTrack& t = tracks_[static_cast<std::size_t>(track)];
    const Prediction prediction =
        predict(camera_, pose, t.previous.u_left, t.previous.v_left, disparity);
    Term term;
    term.valid = prediction.in_front;
    if (!term.valid) return term;
    const ImagePoint seen(t.current.u_left, t.current.v_left, t.current.disparity());
    term.residual << whitening_.cwiseProduct(prediction.image - seen),
        (disparity - t.previous.disparity()) * disparity_weight_;
    term.by_pose << whitening_.asDiagonal() * prediction.by_pose,
        Eigen::Matrix<double, 1, 6>::Zero();
    term.by_disparity << whitening_.cwiseProduct(prediction.by_disparity), disparity_weight_;
    return term;
  }

  const StereoCalibration& camera_;
  const StereoParameters& parameters_;
  std::span<const StereoTrack> tracks_;
  double disparity_weight_;
  Eigen::Vector3d whitening_;
};

// One round with a fixed set of tracks; false where the equations have no finite solution.
bool levenberg_marquardt(const Adjustment& adjustment, const StereoParameters& parameters,
                         Refinement* result) {
  std::vector<double> disparities, tried_disparities;
  double cost = adjustment.cost(result->T_previous_current, result->inliers, &disparities);
  double damping = 1e-6;
  for (int i = 0; i < parameters.refine_max_iterations; ++i, ++result->iterations) {
    Matrix6 information;
    Vector6 gradient;
    adjustment.normal_equations(result->T_previous_current, result->inliers, disparities,
                                &information, &gradient);
    information.diagonal() *= 1.0 + damping;
    const Vector6 step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return false;
    const Eigen::Isometry3d tried = perturbed(result->T_previous_current, step);
    const double tried_cost = adjustment.cost(tried, result->inliers, &tried_disparities);
    if (tried_cost <= cost) {
      const bool settled = cost - tried_cost < 1e-9 * cost;
      result->T_previous_current = tried;
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

// Inverse information times the residuals' variance. Each track leaves four residuals less its own
// disparity; the Huber weights enter as in Huber, "Robust Statistics" (1981), 7.6.
bool estimate_covariance(const Adjustment& adjustment, Refinement* result) {
  std::vector<double> disparities;
  const double cost =
      adjustment.cost(result->T_previous_current, result->inliers, &disparities);
  const double freedom = 3.0 * static_cast<double>(result->inliers.size()) - 6.0;
  if (freedom <= 0.0) return false;
  Matrix6 information;
  Vector6 gradient;
  adjustment.normal_equations(result->T_previous_current, result->inliers, disparities,
                              &information, &gradient);
  const Eigen::LDLT<Matrix6> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return false;
  result->variance_factor = cost / freedom;
  result->covariance = factor.solve(Matrix6::Identity()) * result->variance_factor;
  result->covariance = (0.5 * (result->covariance + result->covariance.transpose())).eval();
  return result->covariance.allFinite() && (result->covariance.diagonal().array() > 0.0).all();
}

void judge_tracks(const Adjustment& adjustment, int count, double outlier_sigmas,
                  Refinement* result) {
  result->inliers.clear();
  double disparity = 0.0;
  for (int i = 0; i < count; ++i)
    if (adjustment.settle(result->T_previous_current, i, &disparity) <
        outlier_sigmas * outlier_sigmas)
      result->inliers.push_back(i);
}

}  // namespace

Refinement refine_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                         std::span<const StereoTrack> tracks, std::span<const int> inliers,
                         const Eigen::Isometry3d& T_previous_current) {
  Refinement result;
  result.T_previous_current = T_previous_current;
  result.inliers.assign(inliers.begin(), inliers.end());
  const Adjustment adjustment(camera, parameters, tracks);
  if (!levenberg_marquardt(adjustment, parameters, &result)) return result;
  judge_tracks(adjustment, static_cast<int>(tracks.size()), parameters.outlier_sigmas, &result);
  if (result.inliers.size() < 3) return result;
  result.ok = levenberg_marquardt(adjustment, parameters, &result) &&
              estimate_covariance(adjustment, &result);
  return result;
}

}  // namespace maploop::stereo
