#include "estimators/stereo/bundle_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/stereo/adjustment.h"
#include "estimators/stereo/residual.h"
#include "estimators/stereo/velocity_change.h"
#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Returns where the pose that first saw the point sees it now.
ImagePoint image_of(const StereoCalibration& camera, const Eigen::Isometry3d& T_world_cam,
                    const Eigen::Vector3d& p_world) {
  return project(camera, T_world_cam.inverse() * p_world);
}

// Returns the derivative of the point in world with respect to u, v and disparity in this image.
Eigen::Matrix3d by_image(const StereoCalibration& camera, const Eigen::Isometry3d& T_world_cam,
                         const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_cam = T_world_cam.inverse() * p_world;
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  J(0, 0) = p_cam.z() / camera.fx;
  J(1, 1) = p_cam.z() / camera.fy;
  J.col(2) = triangulate_by_disparity(p_cam, camera.fx * camera.baseline / p_cam.z());
  return T_world_cam.linear() * J;
}

double seconds_between(const Window& window, std::size_t from) {
  return to_seconds(window.poses[from + 1].stamp - window.poses[from].stamp);
}

VelocityChange change_at(const Window& window, std::size_t first) {
  return velocity_change({window.poses[first].T_world_cam, window.poses[first + 1].T_world_cam,
                          window.poses[first + 2].T_world_cam},
                         {seconds_between(window, first), seconds_between(window, first + 1)});
}

// Returns the time in s between the mean velocities of two successive motions.
double seconds_of_change(const Window& window, std::size_t first) {
  return 0.5 * (seconds_between(window, first) + seconds_between(window, first + 1));
}

// Returns the first row of a pose's equations. The first pose of the window has no rows.
int row_of(std::size_t pose) {
  return 6 * (static_cast<int>(pose) - 1);
}

Eigen::Matrix4d damped(Eigen::Matrix4d information, double damping) {
  information.diagonal() *= 1.0 + damping;
  return information;
}

}  // namespace

BundleAdjustment::BundleAdjustment(const StereoCalibration& camera,
                                   const StereoParameters& parameters)
    : camera_(camera),
      weight_(1.0 / parameters.sigma_track, 1.0 / parameters.sigma_track,
              1.0 / parameters.sigma_disparity),
      match_weight_(1.0 / std::max(1e-3, parameters.sigma_match)),
      huber_(parameters.huber),
      outlier_(parameters.outlier_sigmas),
      correlated_pairs_(parameters.correlated_pairs),
      max_iterations_(parameters.window_iterations),
      equations_(static_cast<std::size_t>(parameters.window_max_points)),
      tried_(parameters) {
  change_weight_ << Eigen::Vector3d::Constant(1.0 / parameters.sigma_acceleration),
      Eigen::Vector3d::Constant(1.0 / parameters.sigma_turn_acceleration);
}

double BundleAdjustment::robust_cost(double squared) const {
  const double capped = std::min(squared, outlier_ * outlier_);
  return capped <= huber_ * huber_ ? capped : 2.0 * huber_ * std::sqrt(capped) - huber_ * huber_;
}

double BundleAdjustment::robust_weight(double squared) const {
  if (squared > outlier_ * outlier_) return 0.0;
  return squared <= huber_ * huber_ ? 1.0 : huber_ / std::sqrt(squared);
}

double BundleAdjustment::square(const Window& window, const WindowPoint& point,
                                std::size_t pose) const {
  const Eigen::Vector3d p_cam = window.poses[pose].T_world_cam.inverse() * point.p_world;
  if (!(p_cam.z() > 0.1)) return std::numeric_limits<double>::infinity();
  Eigen::Vector3d residual = project(camera_, p_cam) - point.sights[pose].image;
  residual.z() += point.match_error;
  return residual.cwiseProduct(weight_).squaredNorm();
}

double BundleAdjustment::cost(const Window& window) const {
  double sum = 0.0;
  for (const WindowPoint& point : window.points) {
    sum += std::pow(point.match_error * match_weight_, 2);  // (10) of METHOD.md
    for (std::size_t i = 0; i < window.poses.size(); ++i)
      if (point.sights[i].seen) sum += robust_cost(square(window, point, i));
  }
  for (std::size_t i = 0; i + 2 < window.poses.size(); ++i) {
    // (11) of METHOD.md
    sum += change_at(window, i).value.cwiseProduct(change_weight_).squaredNorm() /
           std::pow(seconds_of_change(window, i), 2);
  }
  return sum;
}

BundleAdjustment::Term BundleAdjustment::linearize(const Window& window, const WindowPoint& point,
                                                   std::size_t pose,
                                                   const Eigen::Matrix3d& point_by_image) const {
  const View view = view_point(camera_, window.poses[pose].T_world_cam, point.p_world);
  Term term;
  term.valid = view.in_front;
  if (!term.valid) return term;
  term.residual = view.image - point.sights[pose].image;
  term.residual.z() += point.match_error;
  term.by_pose = weight_.asDiagonal() * view.by_pose;
  term.by_point.leftCols<3>() = weight_.asDiagonal() * view.by_point * point_by_image;
  term.by_point.col(3) = Eigen::Vector3d(0.0, 0.0, weight_.z());
  term.residual = term.residual.cwiseProduct(weight_).eval();
  return term;
}

void BundleAdjustment::add_velocity_changes(const Window& window) {
  for (std::size_t first = 0; first + 2 < window.poses.size(); ++first) {
    VelocityChange change = change_at(window, first);
    const Eigen::Matrix<double, 6, 1> weight = change_weight_ / seconds_of_change(window, first);
    change.value = change.value.cwiseProduct(weight).eval();
    for (auto& J : change.by_pose) J = (weight.asDiagonal() * J).eval();
    for (std::size_t a = first == 0 ? 1 : 0; a < 3; ++a) {
      const int row = row_of(first + a);
      gradient_.segment<6>(row) += change.by_pose[a].transpose() * change.value;
      for (std::size_t b = first == 0 ? 1 : 0; b < 3; ++b) {
        information_.block<6, 6>(row, row_of(first + b)) +=
            change.by_pose[a].transpose() * change.by_pose[b];
      }
    }
  }
}

void BundleAdjustment::add_points(const Window& window) {
  const std::size_t poses = window.poses.size();
  for (std::size_t k = 0; k < window.points.size(); ++k) {
    const WindowPoint& point = window.points[k];
    PointEquations& own = equations_[k];
    own.information = Eigen::Vector4d(1e-9, 1e-9, 1e-9, match_weight_ * match_weight_).asDiagonal();
    own.gradient = Vector4(0.0, 0.0, 0.0, match_weight_ * match_weight_ * point.match_error);
    const Eigen::Matrix3d point_by_image =
        by_image(camera_, window.poses[point.first_seen(poses)].T_world_cam, point.p_world);
    for (std::size_t i = 0; i < poses; ++i) {
      own.coupling[i].setZero();
      if (!point.sights[i].seen) continue;
      const Term term = linearize(window, point, i, point_by_image);
      const double weight = term.valid ? robust_weight(term.residual.squaredNorm()) : 0.0;
      if (weight == 0.0) continue;
      own.information += weight * term.by_point.transpose() * term.by_point;
      own.gradient += weight * term.by_point.transpose() * term.residual;
      if (i == 0) continue;
      const int row = row_of(i);
      information_.block<6, 6>(row, row) += weight * term.by_pose.transpose() * term.by_pose;
      gradient_.segment<6>(row) += weight * term.by_pose.transpose() * term.residual;
      own.coupling[i] = weight * term.by_pose.transpose() * term.by_point;
    }
  }
}

// Subtracts the points' share from the poses' equations (Schur complement).
void BundleAdjustment::eliminate_points(const Window& window, double damping) {
  information_.diagonal() *= 1.0 + damping;
  for (std::size_t k = 0; k < window.points.size(); ++k) {
    const auto& sights = window.points[k].sights;
    const PointEquations& own = equations_[k];
    const Eigen::Matrix4d inverse = damped(own.information, damping).inverse();
    for (std::size_t i = 1; i < window.poses.size(); ++i) {
      if (!sights[i].seen) continue;
      const Eigen::Matrix<double, 6, 4> gain = own.coupling[i] * inverse;
      gradient_.segment<6>(row_of(i)) -= gain * own.gradient;
      for (std::size_t j = 1; j < window.poses.size(); ++j) {
        if (sights[j].seen)
          information_.block<6, 6>(row_of(i), row_of(j)) -= gain * own.coupling[j].transpose();
      }
    }
  }
}

void BundleAdjustment::step(const Window& from, const Vector& of_poses, double damping,
                            Window* to) const {
  to->poses = from.poses;
  to->points = from.points;
  for (std::size_t i = 1; i < from.poses.size(); ++i)
    to->poses[i].T_world_cam = perturbed(from.poses[i].T_world_cam, of_poses.segment<6>(row_of(i)));
  for (std::size_t k = 0; k < from.points.size(); ++k) {
    const PointEquations& own = equations_[k];
    Vector4 right = -own.gradient;
    for (std::size_t i = 1; i < from.poses.size(); ++i)
      right -= own.coupling[i].transpose() * of_poses.segment<6>(row_of(i));
    const Vector4 change = damped(own.information, damping).inverse() * right;
    const Eigen::Isometry3d& anchor =
        from.poses[from.points[k].first_seen(from.poses.size())].T_world_cam;
    ImagePoint image = image_of(camera_, anchor, from.points[k].p_world) + change.head<3>();
    image.z() = std::max(smallest_disparity, image.z());
    to->points[k].p_world = anchor * triangulate(camera_, image);
    to->points[k].match_error += change[3];
  }
}

void BundleAdjustment::set_up(const Window& window) {
  const int size = row_of(window.poses.size());
  information_.setZero(size, size);
  gradient_.setZero(size);
  add_velocity_changes(window);
  add_points(window);
}

std::optional<Matrix6> BundleAdjustment::newest_covariance(const Window& window) {
  const std::size_t poses = window.poses.size();
  if (poses < 3) return std::nullopt;
  int seen = 0;
  for (const WindowPoint& point : window.points)
    for (std::size_t i = 0; i < poses; ++i) seen += point.sights[i].seen ? 1 : 0;
  const double freedom = 3.0 * seen - 3.0 * static_cast<double>(window.points.size()) - 6.0;
  if (freedom <= 0.0) return std::nullopt;

  set_up(window);
  eliminate_points(window, 0.0);
  const int earlier = row_of(poses - 2), newest = row_of(poses - 1);
  const Eigen::Isometry3d& from = window.poses[poses - 2].T_world_cam;
  const Eigen::Isometry3d& to = window.poses[poses - 1].T_world_cam;
  const Eigen::Matrix3d R = from.linear().transpose();
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, largest_size> J;
  J.setZero(6, row_of(poses));
  J.block<3, 3>(0, newest) = R;
  J.block<3, 3>(3, newest + 3) = R;
  J.block<3, 3>(0, earlier) = -R;
  J.block<3, 3>(0, earlier + 3) = R * cross_matrix(to.translation() - from.translation());
  J.block<3, 3>(3, earlier + 3) = -R;
  const Eigen::LDLT<Matrix> factor(information_);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
  const Matrix6 covariance =
      J * factor.solve(J.transpose()) * (cost(window) / freedom * correlated_pairs_);
  if (!covariance.allFinite()) return std::nullopt;
  return 0.5 * (covariance + covariance.transpose());
}

bool BundleAdjustment::adjust(Window* window) {
  const std::size_t poses = window->poses.size();
  if (poses < 3) return true;  // the motion was already estimated from two poses
  double best = cost(*window);
  double damping = 1e-6;
  for (int iteration = 0; iteration < max_iterations_; ++iteration) {
    set_up(*window);
    eliminate_points(*window, damping);
    const Vector of_poses = -information_.ldlt().solve(gradient_);
    if (!of_poses.allFinite()) return false;
    step(*window, of_poses, damping, &tried_);
    const double tried = cost(tried_);
    if (tried <= best) {
      const bool settled = best - tried <= 1e-4 * best;
      std::swap(window->poses, tried_.poses);
      std::swap(window->points, tried_.points);
      best = tried;
      damping *= 0.1;
      if (settled) break;
    } else {
      damping = std::max(damping * 100.0, 1e-3);
    }
  }
  return std::isfinite(best);
}

}  // namespace maploop::stereo
