#include "estimators/lidar/degeneracy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace maploop::lidar {

Degeneracy find_degeneracy(const Matrix6d& information, int points, double range,
                           double min_information) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>() /= range;
  // (7) of METHOD.md
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scale.asDiagonal() * information *
                                                       scale.asDiagonal() / points);
  Degeneracy result;
  result.eigenvalues = solver.eigenvalues();
  Matrix6d seen = Matrix6d::Zero(), inverse = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d direction = solver.eigenvectors().col(i);
    if (solver.eigenvalues()[i] >= std::max(min_information, 1e-9)) {
      seen += direction * direction.transpose();
      inverse += direction * direction.transpose() / (solver.eigenvalues()[i] * points);
    } else {
      int largest = 0;
      direction.cwiseAbs().maxCoeff(&largest);
      result.directions = static_cast<std::uint8_t>(result.directions | 1u << largest);
    }
  }
  result.seen = scale.asDiagonal() * seen * scale.cwiseInverse().asDiagonal();
  result.inverse = scale.asDiagonal() * inverse * scale.asDiagonal();
  return result;
}

}  // namespace maploop::lidar
