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
bool joseph_update(StateVector& x, StateMatrix& P, const Innovation<rows>& innovation,
                   Considered considered, double max_tilt) {
  using Columns = Eigen::Matrix<double, index::count, rows>;
  const Columns PH = P * innovation.H.transpose();
  const Eigen::Matrix<double, rows, rows> S = innovation.H * PH + innovation.R;
  Columns K = PH * S.inverse();  // (11) of METHOD.md
  for (const int i : considered) K.row(i).setZero();
  StateVector corrected = x;
  add_correction(corrected, K * innovation.residual);
  if (lean(corrected) > std::max(max_tilt, lean(x))) return false;
  x = corrected;
  const Columns half = PH - 0.5 * K * S;
  const StateMatrix change = K * half.transpose();
  P -= change + change.transpose();  // in one step, so that P stays symmetric to the last bit
  return true;
}

template struct Innovation<1>;
template struct Innovation<2>;
template struct Innovation<3>;
template struct Innovation<6>;
template bool joseph_update(StateVector&, StateMatrix&, const Innovation<1>&, Considered, double);
template bool joseph_update(StateVector&, StateMatrix&, const Innovation<2>&, Considered, double);
template bool joseph_update(StateVector&, StateMatrix&, const Innovation<3>&, Considered, double);
template bool joseph_update(StateVector&, StateMatrix&, const Innovation<6>&, Considered, double);

}  // namespace maploop::fusion
