#include "tests/estimators/fusion/least_eigenvalue.h"

#include <Eigen/Eigenvalues>

namespace maploop::testing {

double least_eigenvalue(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
}

}  // namespace maploop::testing
