// How fast azimuth, pitch and roll change, from one gyro or from three.
#pragma once

#include <Eigen/Core>

#include "estimators/fusion/earth.h"
#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/inertial_input.h"

namespace maploop::fusion {

struct AttitudeRates {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  // rad/s, of azimuth, pitch and roll
  Eigen::Matrix<double, 3, index::count> by_state = Eigen::Matrix<double, 3, index::count>::Zero();
  double level = 1.0;  // of one gyro: what its rate is divided by to be that of the azimuth
  Eigen::Matrix3d by_gyro =
      Eigen::Matrix3d::Zero();  // per rate about body x, y and z; of three gyros
};

// With one gyro the vehicle turns about the vertical, and pitch and roll stay (3); with three the
// rates are those of the Euler angles, without the Earth's own rate (30). The input is inertial.
AttitudeRates attitude_rates(const StateVector& x, const InertialInput& input,
                             const LocalEarth& earth);

}  // namespace maploop::fusion
