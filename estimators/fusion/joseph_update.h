// This is the Kalman measurement update in Joseph's form with a chi-square gate (Bar-Shalom, Li and
// Kirubarajan 2001, 5.2 and 5.4).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/outcome.h"

namespace maploop::fusion {

// Holds the residual z - h(x), H = dh/dx and the covariance R of the measurement noise, for `rows`
// scalar measurements.
template <int rows>
struct Innovation {
  Eigen::Matrix<double, rows, 1> residual = Eigen::Matrix<double, rows, 1>::Zero();
  Eigen::Matrix<double, rows, index::count> H = Eigen::Matrix<double, rows, index::count>::Zero();
  Eigen::Matrix<double, rows, rows> R = Eigen::Matrix<double, rows, rows>::Zero();

  Innovation() = default;
  Innovation(double difference, double variance) requires(rows == 1) {
    residual << difference;
    R << variance;
  }

  // Returns `n` of the rows, from `first` on.
  template <int n>
  Innovation<n> part(int first) const {
    Innovation<n> some;
    some.residual = residual.template segment<n>(first);
    some.H = H.template middleRows<n>(first);
    some.R = R.template block<n, n>(first, first);
    return some;
  }

  // Makes `n` rows, from `first` on, say nothing: an update does not change the state by them.
  void leave_out(int first, int n) {
    residual.segment(first, n).setZero();
    H.middleRows(first, n).setZero();
    R.middleRows(first, n).setZero();
    R.middleCols(first, n).setZero();
    R.diagonal().segment(first, n).setOnes();
  }

  Eigen::Matrix<double, rows, rows> covariance(const StateMatrix& P) const;

  // Returns the normalized innovation squared, which is chi-square distributed with `rows` degrees
  // of freedom if state and measurement are consistent.
  double nis(const StateMatrix& P) const;
};

// These states are considered (Schmidt 1966): an update does not change them, but their uncertainty
// counts in the gain and in the covariance.
using Considered = std::initializer_list<int>;

// Returns by how much the vehicle leans, rad.
inline double lean(const StateVector& x) {
  return std::max(std::abs(x[index::pitch]), std::abs(x[index::roll]));
}

// Corrects the state and the covariance. If the vehicle would then lean by more than `max_tilt`
// (rad), and more than before, it changes nothing and returns false: a velocity against the travel
// could otherwise turn the vehicle upside down, which mirrors its azimuth. The covariance is (I -
// KH) P (I - KH)^T + K R K^T multiplied out, which holds for any gain, so a rounding error of the
// gain has an effect of second order only. The cost is that of the `rows` rows only.
template <int rows>
bool joseph_update(StateVector& x, StateMatrix& P, const Innovation<rows>& innovation,
                   Considered considered = {},
                   double max_tilt = std::numeric_limits<double>::infinity());

// Applies one measurement of any kind at the state's stamp. If it contradicts the prediction by
// more than `gate` (chi-square, `rows` degrees of freedom), it is refused with `reason`, and if it
// would lean the vehicle by more than `max_tilt`, for that; the state does not change then. If the
// sensor's innovations have lately been larger than their covariance by the factor `excess`, a
// measurement is judged as it is, but has less weight.
template <int rows>
Outcome apply_gated(FilterState& state, const Innovation<rows>& innovation, double gate,
                    Reason reason, double max_tilt, double excess = 1.0) {
  if (!(innovation.nis(state.P) <= gate)) return refused(reason);  // (10) of METHOD.md
  Innovation<rows> weighted = innovation;
  if (excess > 1.0) weighted.R += (excess - 1.0) * innovation.covariance(state.P);
  const bool done = joseph_update(state.x, state.P, weighted, {}, max_tilt);
  return done ? Outcome{} : refused(Reason::implausible_tilt);
}

// The instances are compiled once, in joseph_update.cpp.
extern template struct Innovation<1>;
extern template struct Innovation<2>;
extern template struct Innovation<3>;
extern template struct Innovation<6>;

}  // namespace maploop::fusion
