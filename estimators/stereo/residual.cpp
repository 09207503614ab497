#include "estimators/stereo/residual.h"

#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

constexpr double nearest_depth = 0.1;  // m; a windscreen camera sees no nearer object sharply

}  // namespace

View view_point(const StereoCalibration& camera, const Eigen::Isometry3d& T_world_cam,
                const Eigen::Vector3d& p_world) {
  View view;
  const Eigen::Vector3d from_camera = p_world - T_world_cam.translation();
  const Eigen::Matrix3d R_cam_world = T_world_cam.linear().transpose();
  const Eigen::Vector3d p_cam = R_cam_world * from_camera;
  if (!(p_cam.z() > nearest_depth)) return view;

  view.in_front = true;
  view.image = project(camera, p_cam);
  view.by_point = project_jacobian(camera, p_cam) * R_cam_world;
  view.by_pose.leftCols<3>() = -view.by_point;
  view.by_pose.rightCols<3>() = view.by_point * cross_matrix(from_camera);
  return view;
}

Prediction predict(const StereoCalibration& camera, const Eigen::Isometry3d& T_previous_current,
                   double u_left, double v_left, double disparity) {
  const Eigen::Vector3d p_previous = triangulate(camera, {u_left, v_left, disparity});
  const View view = view_point(camera, T_previous_current, p_previous);
  return {view.image, view.by_pose, view.by_point * triangulate_by_disparity(p_previous, disparity),
          view.in_front};
}

Eigen::Isometry3d perturbed(const Eigen::Isometry3d& pose,
                            const Eigen::Matrix<double, 6, 1>& perturbation) {
  const Eigen::Vector3d rotation = perturbation.tail<3>();
  const double angle = rotation.norm();
  Eigen::Quaterniond q(pose.linear());
  if (angle > 0.0) q = Eigen::AngleAxisd(angle, rotation / angle) * q;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = q.normalized().toRotationMatrix();
  result.translation() = pose.translation() + perturbation.head<3>();
  return result;
}

}  // namespace maploop::stereo
