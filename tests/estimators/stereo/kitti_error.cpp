#include "tests/estimators/stereo/kitti_error.h"

#include <Eigen/SVD>
#include <fstream>
#include <functional>
#include <stdexcept>

namespace maploop::testing {
namespace {

using Visit = std::function<void(const Eigen::Isometry3d&, const Eigen::Isometry3d&)>;

void for_each_segment(const Trajectory& estimate, const Trajectory& truth, double length,
                      const Visit& visit) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    double distance = 0.0;
    for (std::size_t j = i + 1; j < truth.size(); ++j) {
      distance += (truth[j].translation() - truth[j - 1].translation()).norm();
      if (distance <= length) continue;
      visit(estimate[i].inverse() * estimate[j], truth[i].inverse() * truth[j]);
      break;
    }
  }
}

}  // namespace

SegmentError kitti_error(const Trajectory& estimate, const Trajectory& truth, double length) {
  SegmentError error;
  for_each_segment(estimate, truth, length,
                   [&](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
                     const Eigen::Isometry3d difference = a.inverse() * b;
                     error.translation += difference.translation().norm() / length;
                     error.rotation += Eigen::AngleAxisd(difference.linear()).angle() / length;
                     ++error.segments;
                   });
  if (error.segments > 0) {
    error.translation /= error.segments;
    error.rotation /= error.segments;
  }
  for (std::size_t i = 1; i < truth.size(); ++i)
    error.distance += (truth[i].translation() - truth[i - 1].translation()).norm();
  const Eigen::Isometry3d end = (estimate.front().inverse() * estimate.back()).inverse() *
                                (truth.front().inverse() * truth.back());
  error.end_point = end.translation().norm();
  return error;
}

Trajectory without_common_rotation(const Trajectory& estimate, const Trajectory& truth) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for_each_segment(estimate, truth, 25.0,
                   [&](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
                     moments += a.translation() * b.translation().transpose();
                   });
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, (svd.matrixV() * svd.matrixU().transpose()).determinant());
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  Trajectory turned;
  for (const Eigen::Isometry3d& pose : estimate) turned.push_back(turn * pose * turn.inverse());
  return turned;
}

Trajectory read_kitti_poses(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  Trajectory poses;
  Eigen::Matrix<double, 3, 4> rows;
  while (true) {
    for (int i = 0; i < 12; ++i) stream >> rows(i / 4, i % 4);
    if (!stream) return poses;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond(Eigen::Matrix3d(rows.leftCols<3>())).normalized().toRotationMatrix();
    pose.translation() = rows.col(3);
    poses.push_back(pose);
  }
}

}  // namespace maploop::testing
