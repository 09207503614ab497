#include "estimators/stereo/adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimators/stereo/residual.h"

namespace maploop::stereo {
namespace {

constexpr double infinite_cost = std::numeric_limits<double>::infinity();

}  // namespace

Adjustment::Adjustment(const StereoCalibration& camera, const StereoParameters& parameters,
                       std::span<const StereoTrack> tracks)
    : camera_(camera),
      tracks_(tracks),
      track_weight_(1.0 / parameters.sigma_track),
      change_weight_(1.0 / parameters.sigma_disparity),
      level_weight_(1.0 / std::hypot(parameters.sigma_disparity,
                                     std::numbers::sqrt2 * parameters.sigma_match)),
      huber_(parameters.huber) {}

double Adjustment::huber_cost(double squared) const {
  return squared <= huber_ * huber_ ? squared : 2.0 * huber_ * std::sqrt(squared) - huber_ * huber_;
}

double Adjustment::huber_weight(double squared) const {
  return squared <= huber_ * huber_ ? 1.0 : huber_ / std::sqrt(squared);
}

void Adjustment::whiten(Term* term) const {
  const auto apply = [this](auto&& rows) {
    rows.template topRows<2>() *= track_weight_;  // (5) of METHOD.md
    const auto sum = ((rows.row(2) + rows.row(3)) * (level_weight_ / std::numbers::sqrt2)).eval();
    rows.row(3) = ((rows.row(2) - rows.row(3)) * (change_weight_ / std::numbers::sqrt2)).eval();
    rows.row(2) = sum;
  };
  apply(term->residual);
  apply(term->by_shared);
  apply(term->by_disparity);
}

Adjustment::Term Adjustment::linearize(const Eigen::Isometry3d& pose, int track,
                                       double disparity) const {
  const StereoTrack& t = tracks_[static_cast<std::size_t>(track)];
  const Prediction prediction =
      predict(camera_, pose, t.previous.u_left, t.previous.v_left, disparity);
  Term term;
  term.valid = prediction.in_front;
  if (!term.valid) return term;
  const StereoObservation& now = t.current;
  // (4) of METHOD.md
  term.residual << prediction.image.x() - now.u_left, prediction.image.y() - now.v_left,
      prediction.image.z() - now.disparity(), disparity - t.previous.disparity();
  term.by_shared.topLeftCorner<3, 6>() = prediction.by_pose;
  term.by_shared.bottomLeftCorner<1, 6>().setZero();
  term.by_shared.col(6) << 0.0, 0.0, -1.0, -1.0;
  term.by_disparity << prediction.by_disparity, 1.0;
  whiten(&term);
  return term;
}

double Adjustment::settle(const Eigen::Isometry3d& pose, int track, double* disparity) const {
  *disparity =
      std::max(smallest_disparity, tracks_[static_cast<std::size_t>(track)].previous.disparity());
  for (int i = 0; i < 2; ++i) {  // nearly linear: the second step is at most 1e-3 px
    const Term term = linearize(pose, track, *disparity);
    if (!term.valid) return infinite_cost;
    *disparity -= term.by_disparity.dot(term.residual) / term.by_disparity.squaredNorm();
    *disparity = std::max(smallest_disparity, *disparity);
  }
  const Term term = linearize(pose, track, *disparity);
  return term.valid ? term.residual.squaredNorm() : infinite_cost;
}

double Adjustment::cost(const Eigen::Isometry3d& pose, std::span<const int> inliers,
                        std::vector<double>* disparities) const {
  disparities->resize(inliers.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < inliers.size(); ++i)
    sum += huber_cost(settle(pose, inliers[i], &(*disparities)[i]));
  return sum;
}

NormalEquations Adjustment::normal_equations(const Eigen::Isometry3d& pose,
                                             std::span<const int> inliers,
                                             const std::vector<double>& disparities) const {
  NormalEquations equations;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    const Term term = linearize(pose, inliers[i], disparities[i]);
    if (!term.valid) continue;
    const double weight = huber_weight(term.residual.squaredNorm());
    const Vector7 coupling = term.by_shared.transpose() * term.by_disparity;
    const double own = term.by_disparity.squaredNorm();
    equations.information += weight * (term.by_shared.transpose() * term.by_shared -
                                       coupling * coupling.transpose() / own);
    equations.gradient += weight * (term.by_shared.transpose() * term.residual -
                                    coupling * (term.by_disparity.dot(term.residual) / own));
  }
  return equations;
}

}  // namespace maploop::stereo
