#include "tools/calibrate/board_adjustment.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace maploop::calibrate {
namespace {

using sensors::CameraModel;
using CommonMatrix = Eigen::Matrix<double, common_parameter_count, common_parameter_count>;
using PoseVector = Eigen::Matrix<double, 6, 1>;  // rotation about the frame's axes, translation
using PoseMatrix = Eigen::Matrix<double, 6, 6>;
using MixedMatrix = Eigen::Matrix<double, common_parameter_count, 6>;

constexpr int right_camera_at = camera_parameter_count, extrinsics_at = 2 * camera_parameter_count;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// Returns the derivatives of a transformed point by a small rotation and translation that are
// applied after the transform.
Eigen::Matrix<double, 3, 6> by_pose(const Eigen::Vector3d& rotated) {
  Eigen::Matrix<double, 3, 6> d;
  d << -cross(rotated), Eigen::Matrix3d::Identity();
  return d;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const PoseVector& by) {
  Eigen::Isometry3d result = pose;
  const Eigen::Vector3d turn = by.head<3>();
  const double angle = turn.norm();
  if (angle > 0.0) {
    result.linear() = Eigen::AngleAxisd(angle, turn / angle) * pose.linear();
  }
  result.translation() += by.tail<3>();
  return result;
}

CameraModel moved(CameraModel camera, const Eigen::Matrix<double, camera_parameter_count, 1>& by) {
  const auto numbers = numbers_of(camera);
  for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] += by[static_cast<Eigen::Index>(i)];
  return camera;
}

Cameras moved(const Cameras& cameras, const CommonVector& by) {
  return {moved(cameras.left, by.head<camera_parameter_count>()),
          moved(cameras.right, by.segment<camera_parameter_count>(right_camera_at)),
          moved(cameras.T_right_left, by.tail<6>())};
}

// The normal equations of one view: residuals r, and derivatives A by the common parameters, B by
// the board's pose. A_B is the product of A transposed and B.
struct Normals {
  CommonMatrix A_A = CommonMatrix::Zero();
  MixedMatrix A_B = MixedMatrix::Zero();
  PoseMatrix B_B = PoseMatrix::Zero();
  CommonVector A_r = CommonVector::Zero();
  PoseVector B_r = PoseVector::Zero();

  void add(const Eigen::Matrix<double, 2, common_parameter_count>& a,
           const Eigen::Matrix<double, 2, 6>& b, const Eigen::Vector2d& r) {
    A_A += a.transpose() * a;
    A_B += a.transpose() * b;
    B_B += b.transpose() * b;
    A_r += a.transpose() * r;
    B_r += b.transpose() * r;
  }
};

Normals normals_of(const Board& board, const View& view, const Cameras& cameras,
                   const Eigen::Isometry3d& T_left_board) {
  Normals n;
  const auto points = board.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d on_board(points[i].x(), points[i].y(), 0.0);
    const Eigen::Vector3d rotated = T_left_board.linear() * on_board;
    const Eigen::Vector3d in_left = rotated + T_left_board.translation();
    const Eigen::Matrix<double, 3, 6> by_board = by_pose(rotated);

    Eigen::Matrix<double, 2, common_parameter_count> a = decltype(a)::Zero();
    const Projection left = project_with_derivatives(cameras.left, in_left);
    a.leftCols<camera_parameter_count>() = left.by_camera;
    n.add(a, left.by_point * by_board, view.left[i] - left.pixel);

    const Eigen::Vector3d turned = cameras.T_right_left.linear() * in_left;
    const Projection right =
        project_with_derivatives(cameras.right, turned + cameras.T_right_left.translation());
    a.setZero();
    a.middleCols<camera_parameter_count>(right_camera_at) = right.by_camera;
    a.rightCols<6>() = right.by_point * by_pose(turned);
    n.add(a, right.by_point * cameras.T_right_left.linear() * by_board,
          view.right[i] - right.pixel);
  }
  return n;
}

std::vector<Normals> normals_of(const Board& board, const std::vector<View>& views,
                                const Adjustment& at) {
  std::vector<Normals> normals;
  for (std::size_t v = 0; v < views.size(); ++v)
    normals.push_back(normals_of(board, views[v], at.cameras, at.T_left_board[v]));
  return normals;
}

double sum_of_squares(const Residuals& residuals) {
  double sum = 0.0;
  for (const auto& view : residuals) {
    for (const Corners& side : view)
      for (const Eigen::Vector2d& r : side) sum += r.squaredNorm();
  }
  return sum;
}

double mean_distance(double squares, std::size_t count) {
  return std::sqrt(squares / static_cast<double>(count));
}

// The normal equations of the common parameters after the views' poses are eliminated: S x = s.
// `damping` scales the diagonals up.
struct Reduced {
  CommonMatrix S = CommonMatrix::Zero();
  CommonVector s = CommonVector::Zero();
};

PoseMatrix damped_inverse(const PoseMatrix& m, double damping) {
  PoseMatrix d = m;
  d.diagonal() *= 1.0 + damping;
  return d.inverse();
}

Reduced reduce(const std::vector<Normals>& views, double damping) {
  Reduced reduced;
  for (const Normals& n : views) {
    const MixedMatrix gain = n.A_B * damped_inverse(n.B_B, damping);
    CommonMatrix damped = n.A_A;
    damped.diagonal() *= 1.0 + damping;
    reduced.S += damped - gain * n.A_B.transpose();
    reduced.s += n.A_r - gain * n.B_r;
  }
  return reduced;
}

// The parameters differ by powers of ten in size, so that S is scaled to a unit diagonal before it
// is inverted.
CommonMatrix scaled_inverse(const CommonMatrix& S) {
  const CommonVector scale = S.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const CommonMatrix unit = scale.asDiagonal() * S * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<CommonMatrix> solver(unit);
  if (!(solver.eigenvalues()[0] > 1e-12)) {
    throw std::runtime_error(
        "the views do not determine every parameter of the cameras: show the board in more "
        "positions, tilted in different directions, and out to the corners of the images");
  }
  return scale.asDiagonal() * solver.eigenvectors() *
         solver.eigenvalues().cwiseInverse().asDiagonal() * solver.eigenvectors().transpose() *
         scale.asDiagonal();
}

}  // namespace

Projection project_with_derivatives(const CameraModel& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d x = point.hnormalized();
  const sensors::DistortedPoint distorted = sensors::apply(camera.distortion, x);
  const auto by_coefficients = sensors::by_coefficients(x);
  const Eigen::DiagonalMatrix<double, 2> f(camera.fx, camera.fy);
  Projection out;
  out.pixel = camera.pixel(distorted.point);
  out.by_camera << distorted.point.x(), 0.0, 1.0, 0.0, f.diagonal()[0] * by_coefficients.row(0),
      0.0, distorted.point.y(), 0.0, 1.0, f.diagonal()[1] * by_coefficients.row(1);
  Eigen::Matrix<double, 2, 3> by_depth;
  by_depth << 1.0, 0.0, -x.x(), 0.0, 1.0, -x.y();
  out.by_point = f * distorted.by_point * by_depth / point.z();
  return out;
}

Residuals residuals_at(const Board& board, const std::vector<View>& views, const Cameras& cameras,
                       const std::vector<Eigen::Isometry3d>& T_left_board) {
  Residuals residuals(views.size());
  const auto points = board.points();
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d in_left =
          T_left_board[v] * Eigen::Vector3d(points[i].x(), points[i].y(), 0.0);
      const Eigen::Vector3d in_right = cameras.T_right_left * in_left;
      residuals[v][0].push_back(views[v].left[i] -
                                project_with_derivatives(cameras.left, in_left).pixel);
      residuals[v][1].push_back(views[v].right[i] -
                                project_with_derivatives(cameras.right, in_right).pixel);
    }
  }
  return residuals;
}

std::array<double, 2> rms_of(const std::array<Corners, 2>& residuals) {
  std::array<double, 2> rms{};
  for (std::size_t side = 0; side < 2; ++side) {
    double squares = 0.0;
    for (const Eigen::Vector2d& r : residuals[side]) squares += r.squaredNorm();
    rms[side] = mean_distance(squares, residuals[side].size());
  }
  return rms;
}

double rms_of_view(const std::array<Corners, 2>& residuals) {
  const auto [left, right] = rms_of(residuals);
  return std::sqrt(0.5 * (left * left + right * right));
}

Adjustment adjust(const Board& board, const std::vector<View>& views, const Cameras& start,
                  std::vector<Eigen::Isometry3d> T_left_board) {
  constexpr int max_steps = 50;
  constexpr double enough = 1e-12;  // relative change of the sum of squares
  Adjustment result;
  result.cameras = start;
  result.T_left_board = std::move(T_left_board);
  result.residuals = residuals_at(board, views, result.cameras, result.T_left_board);
  double squares = sum_of_squares(result.residuals);
  double damping = 1e-3;
  for (int step = 0; step < max_steps && !result.converged; ++step) {
    const std::vector<Normals> normals = normals_of(board, views, result);
    bool better = false;
    while (!better && damping < 1e12) {
      const Reduced reduced = reduce(normals, damping);
      const CommonVector common = scaled_inverse(reduced.S) * reduced.s;
      const Cameras cameras = moved(result.cameras, common);
      std::vector<Eigen::Isometry3d> poses;
      for (std::size_t v = 0; v < views.size(); ++v) {
        const Normals& n = normals[v];
        poses.push_back(moved(result.T_left_board[v], damped_inverse(n.B_B, damping) *
                                                          (n.B_r - n.A_B.transpose() * common)));
      }
      Residuals residuals = residuals_at(board, views, cameras, poses);
      const double now = sum_of_squares(residuals);
      better = now <= squares;  // false for a sum that is not a number
      if (better) {
        result.converged = squares - now <= enough * squares;
        result.cameras = cameras;
        result.T_left_board = std::move(poses);
        result.residuals = std::move(residuals);
        squares = now;
        damping = std::max(damping * 0.1, 1e-12);
      } else {
        damping *= 10.0;
      }
    }
    if (!better) result.converged = true;  // no step reduces the sum: this is the minimum
  }

  const std::size_t corners = 2 * views.size() * board.points().size();
  const auto redundancy = static_cast<double>(2 * corners) -
                          (common_parameter_count + 6.0 * static_cast<double>(views.size()));
  const CommonMatrix inverse = scaled_inverse(reduce(normals_of(board, views, result), 0.0).S);
  result.sigma = (inverse.diagonal() * squares / redundancy).cwiseSqrt();
  result.rms = mean_distance(squares, corners);
  return result;
}

}  // namespace maploop::calibrate
