#include "estimators/stereo/residual.h"

namespace maploop::stereo {
namespace {

constexpr double kNearest = 0.1;  // m; nothing a windscreen camera sees sharply is nearer

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace

Prediction predict(const StereoCalibration& camera, const Eigen::Isometry3d& T_previous_current,
                   double u_left, double v_left, double disparity) {
  Prediction prediction;
  const Eigen::Vector3d p_previous = triangulate(camera, {u_left, v_left, disparity});
  const Eigen::Vector3d from_camera = p_previous - T_previous_current.translation();
  const Eigen::Matrix3d R_current_previous = T_previous_current.linear().transpose();
  const Eigen::Vector3d p_current = R_current_previous * from_camera;
  if (!(p_current.z() > kNearest)) return prediction;

  prediction.in_front = true;
  prediction.image = project(camera, p_current);
  const Eigen::Matrix3d by_p_previous = project_jacobian(camera, p_current) * R_current_previous;
  prediction.by_pose.leftCols<3>() = -by_p_previous;
  prediction.by_pose.rightCols<3>() = by_p_previous * cross_matrix(from_camera);
  prediction.by_disparity = by_p_previous * triangulate_by_disparity(p_previous, disparity);
  return prediction;
}

Eigen::Isometry3d perturbed(const Eigen::Isometry3d& T_previous_current,
                            const Eigen::Matrix<double, 6, 1>& perturbation) {
  const Eigen::Vector3d rotation = perturbation.tail<3>();
  const double angle = rotation.norm();
  Eigen::Quaterniond q(T_previous_current.linear());
  if (angle > 0.0) q = Eigen::AngleAxisd(angle, rotation / angle) * q;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = q.normalized().toRotationMatrix();
  result.translation() = T_previous_current.translation() + perturbation.head<3>();
  return result;
}

}  // namespace maploop::stereo
