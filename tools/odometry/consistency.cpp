#include "tools/odometry/consistency.h"

#include <Eigen/Cholesky>
#include <map>

#include "msgs/frames.h"
#include "msgs/small_turn.h"
#include "tools/evaluate/kitti_metric.h"
#include "tools/odometry/odometry_input.h"

namespace maploop::odometry {
namespace {

constexpr double truth_position = 0.03;  // m
constexpr double truth_attitude = 0.05;  // deg

// Returns the poses of the truth's body by stamp, turned by the common rotation.
std::map<Time, Eigen::Isometry3d> turned_truth(std::span<const RelativeMotion> motions,
                                               const Eigen::Isometry3d& T_body_cam,
                                               const evaluation::StampedTrajectory& truth) {
  CameraPath path(T_body_cam);
  for (const RelativeMotion& motion : motions) path.add(motion);
  const auto matched = evaluation::match(path.trajectory(), truth, from_seconds(0.001));
  std::map<Time, Eigen::Isometry3d> poses;
  if (matched.truth.size() < 3) return poses;
  // R t_estimate ~ t_truth, so that R^T turns the truth into the estimate's axes.
  const Eigen::Isometry3d common(
      evaluation::fit_common_rotation(matched.estimate, matched.truth).transpose());
  for (std::size_t i = 0; i < matched.truth.size(); ++i) {
    poses[matched.stamps[i]] = T_body_cam * common *
                               (matched.truth.front().inverse() * matched.truth[i]) *
                               common.inverse() * T_body_cam.inverse();
  }
  return poses;
}

}  // namespace

void JoinedMotion::append(const Eigen::Isometry3d& motion, const Matrix6& motion_covariance) {
  Matrix6 carried = Matrix6::Identity();
  carried.topRightCorner<3, 3>() = -cross_matrix(pose.linear() * motion.translation());
  Matrix6 turned = Matrix6::Zero();
  turned.topLeftCorner<3, 3>() = pose.linear();
  turned.bottomRightCorner<3, 3>() = pose.linear();
  covariance =
      (carried * covariance * carried.transpose() + turned * motion_covariance * turned.transpose())
          .eval();
  pose = pose * motion;
}

Eigen::Matrix<double, 6, 1> pose_difference(const Eigen::Isometry3d& estimate,
                                            const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(estimate.linear() * truth.linear().transpose()));
  Eigen::Matrix<double, 6, 1> difference;
  difference << estimate.translation() - truth.translation(), turn.angle() * turn.axis();
  return difference;
}

Consistency consistency(std::span<const RelativeMotion> motions,
                        const Eigen::Isometry3d& T_body_cam,
                        const evaluation::StampedTrajectory& truth, double seconds) {
  const auto poses = turned_truth(motions, T_body_cam, truth);
  Eigen::Matrix<double, 6, 1> own;
  own << Eigen::Vector3d::Constant(truth_position),
      Eigen::Vector3d::Constant(radians(truth_attitude));
  const Matrix6 of_truth = own.cwiseAbs2().asDiagonal();

  Consistency result;
  JoinedMotion joined;
  Time from{}, to{};
  for (const RelativeMotion& motion : motions) {
    if (motion.status != OdometryStatus::ok || motion.from != to) {  // a new increment begins
      joined = {};
      from = to = motion.status == OdometryStatus::ok ? motion.from : motion.stamp;
    }
    if (motion.status != OdometryStatus::ok) continue;
    joined.append(motion.T_from_to(), motion.covariance);
    to = motion.stamp;
    if (to_seconds(to - from) < seconds) continue;
    const auto first = poses.find(from), last = poses.find(to);
    if (first != poses.end() && last != poses.end()) {
      const auto error = pose_difference(joined.pose, first->second.inverse() * last->second);
      const Matrix6 covariance = joined.covariance + of_truth;
      result.nees += error.dot(covariance.ldlt().solve(error)) / 6.0;
      ++result.increments;
    }
    joined = {};
    from = to;
  }
  if (result.increments > 0) result.nees /= result.increments;
  return result;
}

}  // namespace maploop::odometry
