#include "estimators/lidar/gicp_factor.h"

#include <Eigen/Geometry>

namespace maploop::lidar {

using Eigen::Matrix3f;
using Eigen::Vector3f;

Matrix3f plane_to_plane(const Vector3f& normal_a, const Vector3f& normal_b, float thickness) {
  // Woodbury: (2 I - k N N^T)^-1 = I/2 + N Q N^T / 4, with N = [n_a n_b], Q = (I/k - N^T N / 2)^-1.
  const float diagonal = 1.0f / (1.0f - thickness) - 0.5f;
  const float half_cosine = 0.5f * normal_a.dot(normal_b);
  const float scale = 0.25f / (diagonal * diagonal - half_cosine * half_cosine);
  const Vector3f to_a = scale * (diagonal * normal_a + half_cosine * normal_b);
  const Vector3f to_b = scale * (diagonal * normal_b + half_cosine * normal_a);
  Matrix3f W = to_a * normal_a.transpose() + to_b * normal_b.transpose();
  W.diagonal().array() += 0.5f;
  return W;
}

void add_normal_equations(const Vector3f& a, const Vector3f& d, const Matrix3f& W, float weight,
                          Matrix6f* H, Vector6f* g) {
  const Matrix3f M = weight * W;  // (5) of METHOD.md
  const Vector3f y = M * d;
  g->head<3>() -= y;
  g->tail<3>() -= a.cross(y);
  // The lower left block [a]x M is computed column by column.
  Matrix3f AM;
  for (int i = 0; i < 3; ++i) AM.col(i) = a.cross(M.col(i));
  H->topLeftCorner<3, 3>() += M;
  H->bottomLeftCorner<3, 3>() += AM;
  // The lower right block is [a]x^T M [a]x = -[a]x (M [a]x), where M [a]x = -([a]x M)^T.
  const Matrix3f MA = AM.transpose();
  for (int i = 0; i < 3; ++i) H->bottomRightCorner<3, 3>().col(i) += a.cross(MA.col(i));
}

}  // namespace maploop::lidar
