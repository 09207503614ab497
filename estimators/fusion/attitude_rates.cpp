#include "estimators/fusion/attitude_rates.h"

#include <cmath>

namespace maploop::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using namespace index;

AttitudeRates about_vertical(const StateVector& x, const InertialInput& input,
                             const LocalEarth& earth) {
  const double sp = std::sin(x[pitch]), cp = std::cos(x[pitch]);
  const double sr = std::sin(x[roll]), cr = std::cos(x[roll]);
  const double rate = input.yaw_rate - x[gyro_bias];
  AttitudeRates rates;
  rates.value[0] = -(rate / (cp * cr) - earth.earth_rate_up());  // (3) of METHOD.md
  rates.by_state(0, pitch) = -rate * sp / (cp * cp * cr);
  rates.by_state(0, roll) = -rate * sr / (cp * cr * cr);
  rates.by_state(0, gyro_bias) = 1.0 / (cp * cr);
  rates.by_state(0, imu_delay) = -input.change.yaw_rate / (cp * cr);
  rates.level = cp * cr;
  return rates;
}

}  // namespace

AttitudeRates attitude_rates(const StateVector& x, const InertialInput& input,
                             const LocalEarth& earth) {
  if (!input.six_axes) return about_vertical(x, input, earth);
  const double sp = std::sin(x[pitch]), cp = std::cos(x[pitch]);
  const double sr = std::sin(x[roll]), cr = std::cos(x[roll]);
  const Attitude attitude{x[azimuth], x[pitch], x[roll]};
  const Matrix3d to_body = rotation_enu_body(attitude).transpose();
  const Vector3d bias(x[roll_gyro_bias], x[pitch_gyro_bias], x[gyro_bias]);
  const Vector3d w = Vector3d(input.roll_rate, input.pitch_rate, input.yaw_rate) - bias -
                     to_body * earth.earth_rate();

  AttitudeRates rates;
  Matrix3d& T = rates.by_gyro;   // (30) of METHOD.md
  T << 0.0, -sr / cp, -cr / cp,  //
      0.0, -cr, sr,              //
      1.0, -sp * sr / cp, -sp * cr / cp;
  rates.value = T * w;
  const Matrix3d axes = attitude_rate_axes(attitude);
  for (int i = 0; i < 3; ++i) {
    rates.by_state.col(azimuth + i) = T * to_body * axes.col(i).cross(earth.earth_rate());
  }
  Matrix3d T_by_pitch, T_by_roll;
  T_by_pitch << 0.0, -sr * sp / (cp * cp), -cr * sp / (cp * cp),  //
      0.0, 0.0, 0.0,                                              //
      0.0, -sr / (cp * cp), -cr / (cp * cp);
  T_by_roll << 0.0, -cr / cp, sr / cp,  //
      0.0, sr, cr,                      //
      0.0, -sp * cr / cp, sp * sr / cp;
  rates.by_state.col(pitch) += T_by_pitch * w;
  rates.by_state.col(roll) += T_by_roll * w;
  rates.by_state.col(roll_gyro_bias) = -T.col(0);
  rates.by_state.col(pitch_gyro_bias) = -T.col(1);
  rates.by_state.col(gyro_bias) = -T.col(2);
  rates.by_state.col(imu_delay) =
      T * Vector3d(input.change.roll_rate, input.change.pitch_rate, input.change.yaw_rate);
  return rates;
}

}  // namespace maploop::fusion
