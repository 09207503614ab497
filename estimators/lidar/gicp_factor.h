// This factor is the contribution of one pair of surface points to the pose (Segal, Haehnel and
// Thrun, "Generalized-ICP", RSS 2009).
#pragma once

#include <Eigen/Core>

namespace maploop::lidar {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

// Returns (C_a + C_b)^-1 for C = I - (1 - thickness) n n^T, in closed form (Woodbury).
Eigen::Matrix3f plane_to_plane(const Eigen::Vector3f& normal_a, const Eigen::Vector3f& normal_b,
                               float thickness);

// Adds J^T W J and J^T W d, times weight, of the residual d = R^T (b - t) - a, for the pose
// perturbed on the right: T exp(rho, phi), hence J = [-I, [a]x]. Fills only the lower triangle of
// H.
void add_normal_equations(const Eigen::Vector3f& a, const Eigen::Vector3f& d,
                          const Eigen::Matrix3f& W, float weight, Matrix6f* H, Vector6f* g);

}  // namespace maploop::lidar
