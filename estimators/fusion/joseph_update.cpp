#include "estimators/fusion/joseph_update.h"

#include <Eigen/LU>

namespace maploop::fusion {

template <int rows>
Eigen::Matrix<double, rows, rows> Innovation<rows>::covariance(const StateMatrix& P) const {
  return H * P * H.transpose() + R;
}

template <int rows>
double Innovation<rows>::nis(const StateMatrix& P) const {
  return residual.dot(covariance(P).inverse() * residual);
}

template <int rows>
void joseph_update(StateVector& x, StateMatrix& P, const Innovation<rows>& innovation,
                   Considered considered) {
  using Columns = Eigen::Matrix<double, index::count, rows>;
  const Columns PH = P * innovation.H.transpose();
  const Eigen::Matrix<double, rows, rows> S = innovation.H * PH + innovation.R;
  Columns K = PH * S.inverse();  // (11) of METHOD.md
  for (const int i : considered) K.row(i).setZero();
  const Columns half = PH - 0.5 * K * S;
  const StateMatrix change = K * half.transpose();
  P -= change + change.transpose();  // in one step, so that P stays symmetric to the last bit
  add_correction(x, K * innovation.residual);
}

template struct Innovation<1>;
template struct Innovation<2>;
template struct Innovation<3>;
template struct Innovation<6>;
template void joseph_update(StateVector&, StateMatrix&, const Innovation<1>&, Considered);
template void joseph_update(StateVector&, StateMatrix&, const Innovation<2>&, Considered);
template void joseph_update(StateVector&, StateMatrix&, const Innovation<3>&, Considered);
template void joseph_update(StateVector&, StateMatrix&, const Innovation<6>&, Considered);

}  // namespace maploop::fusion
