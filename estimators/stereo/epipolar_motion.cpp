#include "estimators/stereo/epipolar_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "estimators/stereo/residual.h"
#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

using Eigen::Vector3d;
using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Vector5 = Eigen::Matrix<double, 5, 1>;

Vector3d ray(const StereoCalibration& camera, const StereoObservation& seen) {
  return {(seen.u_left - camera.cx) / camera.fx, (seen.v_left - camera.cy) / camera.fy, 1.0};
}

// Returns two unit vectors that complete a direction to an orthogonal frame.
Eigen::Matrix<double, 3, 2> tangents(const Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = direction.unitOrthogonal();
  basis.col(1) = direction.cross(basis.col(0));
  return basis;
}

// Applies two perturbations to the direction and three to the rotation (rotation vector from the
// left).
Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector5& by) {
  Eigen::Matrix<double, 6, 1> perturbation = Eigen::Matrix<double, 6, 1>::Zero();
  perturbation.tail<3>() = by.tail<3>();
  Eigen::Isometry3d result = perturbed(pose, perturbation);
  result.translation() =
      (pose.translation() + tangents(pose.translation()) * by.head<2>()).normalized();
  return result;
}

// Returns the derivative of the Sampson distance by central differences. This is fast enough, as
// there are five unknowns and no deadline depends on this method.
Vector5 sampson_gradient(const StereoCalibration& camera, const Eigen::Isometry3d& pose,
                         const StereoTrack& track) {
  constexpr double difference_step = 1e-6;
  Vector5 gradient;
  for (int i = 0; i < 5; ++i) {
    const Vector5 by = difference_step * Vector5::Unit(i);
    gradient[i] = (sampson_distance(camera, moved(pose, by), track) -
                   sampson_distance(camera, moved(pose, -by), track)) /
                  (2.0 * difference_step);
  }
  return gradient;
}

struct Equations {
  Matrix5 information = Matrix5::Zero();
  Vector5 gradient = Vector5::Zero();
  double cost = 0.0;
};

Equations equations_of(const StereoCalibration& camera, const StereoParameters& parameters,
                       std::span<const StereoTrack> tracks, std::span<const int> inliers,
                       const Eigen::Isometry3d& pose) {
  Equations sum;
  for (const int i : inliers) {
    const StereoTrack& track = tracks[static_cast<std::size_t>(i)];
    const double residual = sampson_distance(camera, pose, track) / parameters.sigma_track;
    const double length = std::abs(residual);
    const double weight = length <= parameters.huber ? 1.0 : parameters.huber / length;
    const Vector5 J = sampson_gradient(camera, pose, track) / parameters.sigma_track;
    sum.information += weight * J * J.transpose();
    sum.gradient += weight * J * residual;
    sum.cost += weight * residual * residual;
  }
  return sum;
}

bool gauss_newton(const StereoCalibration& camera, const StereoParameters& parameters,
                  std::span<const StereoTrack> tracks, std::span<const int> inliers,
                  Eigen::Isometry3d* pose, int* iterations) {
  for (int i = 0; i < parameters.refine_max_iterations; ++i) {
    ++*iterations;
    const Equations equations = equations_of(camera, parameters, tracks, inliers, *pose);
    const Vector5 step = -equations.information.ldlt().solve(equations.gradient);
    if (!step.allFinite() || step.norm() > 1.0) return false;
    *pose = moved(*pose, step);
    if (step.norm() < 1e-8) break;
  }
  return true;
}

// Computes T_previous_current with a translation of length 1; returns false if no geometry fits.
bool five_point(const StereoCalibration& camera, const StereoParameters& parameters,
                std::span<const StereoTrack> tracks, Eigen::Isometry3d* pose,
                std::vector<int>* inliers) {
  std::vector<cv::Point2d> previous, current;
  for (const StereoTrack& track : tracks) {
    const Vector3d from = ray(camera, track.previous), to = ray(camera, track.current);
    previous.emplace_back(from.x(), from.y());
    current.emplace_back(to.x(), to.y());
  }
  cv::Mat mask;
  // OpenCV draws the same random samples in every call.
  const cv::Mat E = cv::findEssentialMat(
      previous, current, 1.0, cv::Point2d(0.0, 0.0), cv::RANSAC, parameters.ransac_confidence,
      parameters.ransac_threshold / camera.fx, parameters.ransac_max_hypotheses, mask);
  if (E.rows != 3 || E.cols != 3) return false;
  cv::Mat R, t;
  cv::recoverPose(E, previous, current, R, t, 1.0, cv::Point2d(0.0, 0.0), mask);
  Eigen::Isometry3d T_current_previous = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      T_current_previous(row, column) = R.at<double>(row, column);
    T_current_previous(row, 3) = t.at<double>(row);
  }
  *pose = T_current_previous.inverse();
  inliers->clear();
  for (int i = 0; i < mask.rows; ++i)
    if (mask.at<unsigned char>(i)) inliers->push_back(i);
  return true;
}

}  // namespace

double sampson_distance(const StereoCalibration& camera,
                        const Eigen::Isometry3d& T_previous_current, const StereoTrack& track) {
  const Eigen::Matrix3d E =
      cross_matrix(T_previous_current.translation()) * T_previous_current.linear();
  const Vector3d previous = ray(camera, track.previous), current = ray(camera, track.current);
  const Vector3d line = E * current;
  const Vector3d back = E.transpose() * previous;
  // Dividing by the focal lengths of both axes gives the distance in pixels.
  const auto square = [&](const Vector3d& l) {
    return std::pow(l.x() / camera.fx, 2) + std::pow(l.y() / camera.fy, 2);
  };
  const double scale = std::sqrt(square(line) + square(back));
  return scale > 0.0 ? previous.dot(line) / scale : 0.0;
}

Refinement epipolar_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                           std::span<const StereoTrack> tracks, double step) {
  Refinement result;
  result.offset_sigma = std::numeric_limits<double>::infinity();
  if (tracks.size() < 6) return result;
  Eigen::Isometry3d pose;
  std::vector<int> agreed;
  if (!five_point(camera, parameters, tracks, &pose, &agreed) || agreed.size() < 6 ||
      !gauss_newton(camera, parameters, tracks, agreed, &pose, &result.iterations))
    return result;
  for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
    if (std::abs(sampson_distance(camera, pose, tracks[static_cast<std::size_t>(i)])) <
        parameters.outlier_sigmas * parameters.sigma_track)
      result.inliers.push_back(i);
  }
  if (result.inliers.size() < 6 ||
      !gauss_newton(camera, parameters, tracks, result.inliers, &pose, &result.iterations))
    return result;

  const Equations equations = equations_of(camera, parameters, tracks, result.inliers, pose);
  const double freedom = static_cast<double>(result.inliers.size()) - 5.0;
  result.variance_factor = std::max(1e-12, equations.cost / freedom);
  const Eigen::LDLT<Matrix5> factor(equations.information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return result;
  const Vector3d direction = pose.translation();
  Eigen::Matrix<double, 6, 5> spread = Eigen::Matrix<double, 6, 5>::Zero();
  spread.topLeftCorner<3, 2>() = step * tangents(direction);
  spread.bottomRightCorner<3, 3>().setIdentity();
  const Matrix5 of_five =
      factor.solve(Matrix5::Identity()) * result.variance_factor * parameters.correlated_pairs;
  result.covariance = spread * (0.5 * (of_five + of_five.transpose())) * spread.transpose();
  result.covariance.topLeftCorner<3, 3>() += step * step * direction * direction.transpose();
  pose.translation() *= step;
  result.T_previous_current = pose;
  result.ok = result.covariance.allFinite() && (result.covariance.diagonal().array() > 0.0).all();
  return result;
}

}  // namespace maploop::stereo
