#pragma once

#include <Eigen/Core>

namespace maploop::testing {

// Of a symmetric matrix. One function for every size: Eigen's solver takes seconds to compile for
// each.
double least_eigenvalue(const Eigen::MatrixXd& symmetric);

}  // namespace maploop::testing
