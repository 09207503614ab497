#include "tools/evaluate/alignment.h"

#include <cmath>
#include <stdexcept>

namespace maploop::evaluation {
namespace {

Eigen::Matrix3Xd positions(const Trajectory& trajectory) {
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(trajectory.size()));
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = trajectory[i].translation();
  return all;
}

Alignment about_the_vertical(const Matched& m, const Eigen::Vector3d& up) {
  const Eigen::Matrix3Xd estimate = positions(m.estimate), truth = positions(m.truth);
  const Eigen::Vector3d from = estimate.rowwise().mean(), to = truth.rowwise().mean();
  double sine = 0.0, cosine = 0.0;
  for (Eigen::Index i = 0; i < truth.cols(); ++i) {
    const Eigen::Vector3d e = estimate.col(i) - from, t = truth.col(i) - to;
    sine += up.dot(e.cross(t));
    cosine += e.dot(t) - up.dot(e) * up.dot(t);
  }
  Alignment a;
  a.motion.linear() = Eigen::AngleAxisd(std::atan2(sine, cosine), up).toRotationMatrix();
  a.motion.translation() = to - a.motion.linear() * from;
  return a;
}

Alignment with_scale(const Matched& m) {
  const Eigen::Matrix4d best = Eigen::umeyama(positions(m.estimate), positions(m.truth), true);
  Alignment a;
  a.scale = std::cbrt(best.topLeftCorner<3, 3>().determinant());
  a.motion.linear() = best.topLeftCorner<3, 3>() / a.scale;
  a.motion.translation() = best.topRightCorner<3, 1>();
  return a;
}

}  // namespace

Eigen::Isometry3d Alignment::operator()(Eigen::Isometry3d pose) const {
  pose.translation() *= scale;
  return motion * pose;
}

Eigen::Isometry3d best_alignment(const Trajectory& estimate, const Trajectory& truth) {
  if (estimate.size() != truth.size() || estimate.size() < 3) {
    throw std::invalid_argument(
        "pose errors need three poses or more of the estimate, and as many of the truth");
  }
  return Eigen::Isometry3d(Eigen::umeyama(positions(estimate), positions(truth), false));
}

Alignment alignment(Align how, const Matched& matched, const Eigen::Vector3d& up,
                    bool has_attitude) {
  if (matched.truth.size() < 3)
    throw std::invalid_argument("an alignment needs three poses or more that match");
  if (how == Align::yaw) return about_the_vertical(matched, up);
  if (how == Align::se3) return {best_alignment(matched.estimate, matched.truth)};
  if (how == Align::sim3) return with_scale(matched);
  if (how == Align::none) return {};
  const Eigen::Isometry3d& estimate = matched.estimate.front();
  const Eigen::Isometry3d& truth = matched.truth.front();
  if (has_attitude) return {truth * estimate.inverse()};
  return {Eigen::Isometry3d(Eigen::Translation3d(truth.translation() - estimate.translation()))};
}

Eigen::Vector3d vertical_of(const StampedTrajectory& trajectory) {
  if (!trajectory.has_attitude) return Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : trajectory.poses) up -= pose.linear().col(1);
  return up.normalized();
}

StampedTrajectory in_frame_at(StampedTrajectory trajectory, const std::optional<Geodetic>& origin) {
  if (!trajectory.origin || !origin) return trajectory;
  const LocalFrame own(*trajectory.origin), other(*origin);
  for (Eigen::Isometry3d& pose : trajectory.poses)
    pose.translation() = other.to_enu(own.to_geodetic(pose.translation()));
  trajectory.origin = origin;
  return trajectory;
}

}  // namespace maploop::evaluation
