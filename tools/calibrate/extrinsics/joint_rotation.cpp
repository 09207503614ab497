#include "tools/calibrate/extrinsics/joint_rotation.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "msgs/small_turn.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double start_sigma = 0.17;  // rad, ten degrees

Matrix3d rotation(const JointRotation& r, Part part) {
  if (part == Part::body) return Matrix3d::Identity();
  return part == Part::camera ? r.R_body_camera : r.R_body_lidar;
}

// Returns where the turn of a part is among the unknowns.
int place(Part part) {
  return part == Part::camera ? 0 : 3;
}

struct Sum {
  Matrix6 normal = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double squares = 0.0;

  template <class J, class R, class I>
  void add(const J& jacobian, const R& residual, const I& information) {
    normal += jacobian.transpose() * information * jacobian;
    gradient += jacobian.transpose() * information * residual;
    squares += residual.dot(information * residual);
  }
};

void add(const MeasuredRotation& m, const JointRotation& now, Sum& sum) {
  const Matrix3d R_a = rotation(now, m.a), R_b = rotation(now, m.b);
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  if (m.a != Part::body) J.middleCols<3>(place(m.a)) = -R_a.transpose();
  if (m.b != Part::body) J.middleCols<3>(place(m.b)) = R_a.transpose();
  sum.add(J, turn_of(m.R_a_b * R_b.transpose() * R_a), m.covariance.inverse().eval());
}

void add(const MeasuredTravel& m, const JointRotation& now, Sum& sum) {
  const Vector3d seen = rotation(now, m.sensor) * m.in_sensor;
  Eigen::Matrix<double, 2, 6> J = Eigen::Matrix<double, 2, 6>::Zero();
  J.middleCols<3>(place(m.sensor)) = -cross_matrix(seen).bottomRows<2>();
  const Eigen::Vector2d sigma(m.left_sigma, m.up_sigma);
  const Eigen::Matrix2d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  sum.add(J, (m.in_body - seen).tail<2>().eval(), information);
}

}  // namespace

JointRotation join(const std::vector<MeasuredRotation>& rotations,
                   const std::optional<MeasuredTravel>& travel, const JointRotation& start) {
  JointRotation now = start;
  Sum sum;
  for (int i = 0; i < 6; ++i) {
    sum = {};
    for (const MeasuredRotation& m : rotations) add(m, now, sum);
    if (travel) add(*travel, now, sum);
    const double information = 1.0 / (start_sigma * start_sigma);
    Vector6 from_start;
    from_start << turn_of(now.R_body_camera * start.R_body_camera.transpose()),
        turn_of(now.R_body_lidar * start.R_body_lidar.transpose());
    sum.normal += information * Matrix6::Identity();
    const Vector6 step = sum.normal.ldlt().solve(sum.gradient - information * from_start);
    now.R_body_camera = rotation_of(step.head<3>()) * now.R_body_camera;
    now.R_body_lidar = rotation_of(step.tail<3>()) * now.R_body_lidar;
  }
  const double measured = 3.0 * static_cast<double>(rotations.size()) + (travel ? 2.0 : 0.0);
  const double redundancy = measured - (rotations.size() > 1 ? 6.0 : 3.0);
  if (redundancy > 0.0) now.contradiction = sum.squares / redundancy;
  now.covariance = std::max(1.0, now.contradiction) * sum.normal.inverse();
  return now;
}

}  // namespace maploop::extrinsics
