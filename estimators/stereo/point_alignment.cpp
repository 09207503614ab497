#include "estimators/stereo/point_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <vector>

#include "estimators/stereo/residual.h"
#include "estimators/stereo/triangulate.h"
#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Returns the covariance (m^2, cam) of a triangulated point from the noise of its left position and
// its disparity.
Matrix3d point_covariance(const StereoCalibration& camera, const StereoParameters& p,
                          const StereoObservation& seen) {
  const Vector3d point = triangulate(camera, image_of(seen));
  Matrix3d J = Matrix3d::Zero();
  J(0, 0) = point.z() / camera.fx;
  J(1, 1) = point.z() / camera.fy;
  J.col(2) = triangulate_by_disparity(point, seen.disparity());
  const double sigma_disparity = std::hypot(p.sigma_disparity, p.sigma_match);
  const Vector3d variance(p.sigma_track * p.sigma_track, p.sigma_track * p.sigma_track,
                          sigma_disparity * sigma_disparity);
  return J * variance.asDiagonal() * J.transpose();
}

class Alignment {
 public:
  Alignment(const StereoCalibration& camera, const StereoParameters& parameters,
            std::span<const StereoTrack> tracks)
      : camera_(camera), parameters_(parameters), tracks_(tracks) {}

  struct Term {
    Vector3d residual;  // whitened
    Eigen::Matrix<double, 3, 6> by_pose;
  };

  Term linearize(const Eigen::Isometry3d& pose, int track) const {
    const StereoTrack& t = tracks_[static_cast<std::size_t>(track)];
    const Vector3d turned = pose.linear() * triangulate(camera_, image_of(t.current));
    const Matrix3d covariance = point_covariance(camera_, parameters_, t.previous) +
                                pose.linear() * point_covariance(camera_, parameters_, t.current) *
                                    pose.linear().transpose();
    const Matrix3d whitening = covariance.llt().matrixL().solve(Matrix3d::Identity());
    Term term;
    term.residual =
        whitening * (turned + pose.translation() - triangulate(camera_, image_of(t.previous)));
    term.by_pose.leftCols<3>() = whitening;
    term.by_pose.rightCols<3>() = -whitening * cross_matrix(turned);
    return term;
  }

  struct Equations {
    Matrix6 information = Matrix6::Zero();
    Vector6 gradient = Vector6::Zero();
    double cost = 0.0;
  };

  Equations equations(const Eigen::Isometry3d& pose, std::span<const int> inliers) const {
    Equations sum;
    for (const int i : inliers) {
      const Term term = linearize(pose, i);
      const double length = term.residual.norm();
      const double huber = parameters_.huber;
      const double weight = length <= huber ? 1.0 : huber / length;
      sum.cost += length <= huber ? length * length : 2.0 * huber * length - huber * huber;
      sum.information += weight * term.by_pose.transpose() * term.by_pose;
      sum.gradient += weight * term.by_pose.transpose() * term.residual;
    }
    return sum;
  }

 private:
  const StereoCalibration& camera_;
  const StereoParameters& parameters_;
  std::span<const StereoTrack> tracks_;
};

void add_prior(const std::optional<MotionPrior>& prior, const Eigen::Isometry3d& pose,
               Alignment::Equations* equations) {
  if (!prior) return;
  const Vector6 residual = prior->residual(pose);
  equations->information += prior->sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  equations->gradient += residual.cwiseQuotient(prior->sigma);
  equations->cost += residual.squaredNorm();
}

// Solves by Gauss-Newton. The covariances rotate with the pose, so they are recomputed in every
// step.
bool gauss_newton(const Alignment& alignment, const std::optional<MotionPrior>& prior,
                  std::span<const int> inliers, int most, Eigen::Isometry3d* pose,
                  int* iterations) {
  for (int i = 0; i < most; ++i) {
    ++*iterations;
    Alignment::Equations equations = alignment.equations(*pose, inliers);
    add_prior(prior, *pose, &equations);
    const Vector6 step = -equations.information.ldlt().solve(equations.gradient);
    if (!step.allFinite()) return false;
    *pose = perturbed(*pose, step);
    if (step.head<3>().norm() < 1e-6 && step.tail<3>().norm() < 1e-8) break;
  }
  return pose->matrix().allFinite();
}

}  // namespace

std::optional<Eigen::Isometry3d> align_points(const StereoCalibration& camera,
                                              const StereoParameters& parameters,
                                              std::span<const StereoTrack> tracks,
                                              std::span<const int> chosen) {
  if (chosen.size() < 3) return std::nullopt;
  const double sigma = std::hypot(parameters.sigma_disparity, parameters.sigma_match);
  std::vector<Vector3d> previous, current;
  std::vector<double> weights;
  double all = 0.0;
  Vector3d previous_centre = Vector3d::Zero(), current_centre = Vector3d::Zero();
  for (const int i : chosen) {
    const StereoTrack& track = tracks[static_cast<std::size_t>(i)];
    previous.push_back(triangulate(camera, image_of(track.previous)));
    current.push_back(triangulate(camera, image_of(track.current)));
    const double noise = std::hypot(depth_sigma(camera, previous.back().z(), sigma),
                                    depth_sigma(camera, current.back().z(), sigma));
    weights.push_back(1.0 / (noise * noise));
    all += weights.back();
    previous_centre += weights.back() * previous.back();
    current_centre += weights.back() * current.back();
  }
  previous_centre /= all;
  current_centre /= all;
  Matrix3d spread = Matrix3d::Zero();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    spread += weights[i] / all * (previous[i] - previous_centre) *
              (current[i] - current_centre).transpose();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > 1e-9 * svd.singularValues()[0])) return std::nullopt;
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      svd.matrixU() * Vector3d(1.0, 1.0, handedness).asDiagonal() * svd.matrixV().transpose();
  pose.translation() = previous_centre - pose.linear() * current_centre;
  if (!pose.matrix().allFinite()) return std::nullopt;
  return pose;
}

Refinement refine_alignment(const StereoCalibration& camera, const StereoParameters& parameters,
                            std::span<const StereoTrack> tracks, std::span<const int> inliers,
                            const std::optional<MotionPrior>& prior) {
  Refinement result;
  result.offset_sigma = std::numeric_limits<double>::infinity();
  const auto start = align_points(camera, parameters, tracks, inliers);
  if (!start) return result;
  result.T_previous_current = *start;

  const Alignment alignment(camera, parameters, tracks);
  const auto adjust = [&](std::span<const int> chosen) {
    return chosen.size() >= 3 &&
           gauss_newton(alignment, prior, chosen, parameters.refine_max_iterations,
                        &result.T_previous_current, &result.iterations);
  };
  if (!adjust(inliers)) return result;
  for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
    if (alignment.linearize(result.T_previous_current, i).residual.norm() <
        parameters.outlier_sigmas)
      result.inliers.push_back(i);
  }
  if (!adjust(result.inliers)) return result;

  const double freedom = 3.0 * static_cast<double>(result.inliers.size()) - 6.0;
  if (freedom <= 0.0) return result;
  Alignment::Equations equations = alignment.equations(result.T_previous_current, result.inliers);
  result.variance_factor = std::max(1e-12, equations.cost / freedom);
  equations.information /= result.variance_factor * parameters.correlated_pairs;
  if (prior)
    equations.information += prior->sigma.cwiseAbs2().cwiseInverse().asDiagonal().toDenseMatrix();
  const Eigen::LDLT<Matrix6> factor(equations.information);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return result;
  result.covariance = factor.solve(Matrix6::Identity());
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.ok = result.covariance.allFinite() && (result.covariance.diagonal().array() > 0.0).all();
  return result;
}

}  // namespace maploop::stereo
