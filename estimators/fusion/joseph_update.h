// Kalman measurement update in Joseph's form, with a chi-square gate (Bar-Shalom, Li and
// Kirubarajan 2001, 5.2 and 5.4).
#pragma once

#include <Eigen/Dense>

#include "estimators/fusion/filter_state.h"

namespace maploop::fusion {

// z - h(x), its derivative H = dh/dx and the measurement's noise R, `rows` at a time.
template <int rows>
struct Innovation {
  Eigen::Matrix<double, rows, 1> residual;
  Eigen::Matrix<double, rows, index::count> H;
  Eigen::Matrix<double, rows, rows> R;

  Eigen::Matrix<double, rows, rows> covariance(const StateMatrix& P) const {
    return H * P * H.transpose() + R;
  }

  // Normalized innovation squared: chi-square with `rows` degrees of freedom when all is well.
  double nis(const StateMatrix& P) const {
    return residual.dot(covariance(P).inverse() * residual);
  }
};

// Correction of the state and covariance after it; P stays symmetric and positive semi-definite.
template <int rows>
void joseph_update(StateVector& x, StateMatrix& P, const Innovation<rows>& innovation) {
  const Eigen::Matrix<double, index::count, rows> K =
      P * innovation.H.transpose() * innovation.covariance(P).inverse();
  const StateMatrix A = StateMatrix::Identity() - K * innovation.H;
  const StateMatrix AP = A * P;
  StateMatrix updated = AP * A.transpose();
  updated += K * innovation.R * K.transpose();
  P = 0.5 * (updated + updated.transpose());
  add_correction(x, K * innovation.residual);
}

}  // namespace maploop::fusion
