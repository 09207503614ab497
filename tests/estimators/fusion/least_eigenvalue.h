#pragma once

#include <Eigen/Core>

namespace maploop::testing {

// Returns the smallest eigenvalue of a symmetric matrix. There is one function for all sizes
// because Eigen's solver takes seconds to compile for each size.
double least_eigenvalue(const Eigen::MatrixXd& symmetric);

}  // namespace maploop::testing
