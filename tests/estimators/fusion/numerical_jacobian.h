// Numerical derivatives are computed here to check the analytical ones.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "estimators/fusion/filter_state.h"

namespace maploop::testing {

// Returns central differences of f: StateVector -> Eigen vector, with a suitable step for each
// state.
template <class F>
auto numerical_jacobian(const F& f, const fusion::StateVector& x) {
  using Value = decltype(f(x));
  Eigen::Matrix<double, Value::RowsAtCompileTime, fusion::index::count> J;
  for (int i = 0; i < fusion::index::count; ++i) {
    const double h = i <= fusion::index::up ? 1.0 : 1e-5;
    fusion::StateVector plus = x, minus = x;
    plus[i] += h;
    minus[i] -= h;
    J.col(i) = (f(plus) - f(minus)) / (2.0 * h);
  }
  return J;
}

// Returns a state whose elements all take effect.
inline fusion::StateVector busy_state() {
  using namespace fusion::index;
  fusion::StateVector x;
  x[east] = 812.0;
  x[north] = -455.0;
  x[up] = 12.0;
  x[speed] = 13.2;
  x[azimuth] = -2.1;
  x[pitch] = 0.07;
  x[roll] = -0.05;
  x[gyro_bias] = 2e-3;
  x[forward_bias] = 0.04;
  x[left_bias] = -0.03;
  x[roll_gyro_bias] = -1e-3;
  x[pitch_gyro_bias] = 3e-3;
  x[unit_course] = 0.03;
  x[up_bias] = 0.1;
  x[imu_delay] = 0.04;
  x[climb_offset] = 0.012;
  x[odometry_course] = -0.02;
  x[odometry_left] = -0.2;
  x[axle_distance] = 0.9;
  x[rear_slip] = 0.007;
  x.segment<3>(lever_forward) << 1.2, -0.4, 0.9;
  x[gnss_delay] = 0.2;
  x[speed_scale] = -0.008;
  x[lidar_scale] = 0.003;
  x[lidar_turn] = -4e-5;
  x[gnss_offset_east] = 0.4;
  x[gnss_offset_north] = -1.1;
  x[gnss_offset_up] = 0.7;
  x[chain_drift] = 0.02;
  x[lane_offset] = 0.0;  // the derivative neglects that its decay depends on the speed
  x[distance] = 1.3;
  x.segment<3>(clone_east) << 813.1, -454.3, 11.9;
  x[clone_azimuth] = -2.04;
  x[clone_pitch] = 0.066;
  x[clone_roll] = -0.053;
  return x;
}

// Returns a covariance of full rank in which all states are correlated.
inline fusion::StateMatrix busy_covariance() {
  using namespace fusion::index;
  fusion::StateMatrix A;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) A(i, j) = std::sin(1.7 * i + 0.9 * j * j + 0.3);
  }
  fusion::StateVector scale = fusion::StateVector::Constant(0.01);
  scale.head<4>().setConstant(0.5);
  scale[gyro_bias] = 1e-3;
  const fusion::StateMatrix P = scale.asDiagonal() *
                                (A * A.transpose() / count + fusion::StateMatrix::Identity()) *
                                scale.asDiagonal();
  return 0.5 * (P + P.transpose());
}

}  // namespace maploop::testing
