#include "estimators/fusion/roll_update.h"

#include <algorithm>
#include <cmath>

namespace maploop::fusion {

std::optional<Innovation<1>> roll_innovation(const FilterState& state, const ImuSample& sample,
                                             double interval, const LocalEarth& earth,
                                             const FusionParameters& parameters) {
  using namespace index;
  using Eigen::Vector3d;
  if (interval <= 0.0) return std::nullopt;
  const StateVector& x = state.x;
  const double ground = state.ground_speed();
  const double g = earth.gravity(x[up]);
  const Vector3d vertical = earth.vertical(x[east], x[north]);
  const Eigen::Matrix3d R = rotation_enu_body(state.attitude());
  const double rate = sample.yaw_rate - x[gyro_bias];
  const double acceleration =
      sample.specific_force_forward - x[forward_bias] - g * vertical.dot(R.col(0));
  if (std::abs(acceleration) > parameters.max_acceleration ||
      std::abs(ground * rate) > parameters.max_lateral_acceleration) {
    return std::nullopt;
  }

  const Vector3d left = R.col(1);
  const Eigen::Matrix3d axes = attitude_rate_axes(state.attitude());
  Innovation<1> innovation;
  // (20) of METHOD.md
  innovation.residual << sample.specific_force_left -
                             (ground * rate + g * vertical.dot(left) + x[left_bias]);
  innovation.H.setZero();
  innovation.H[east] = g * earth.curvature().x() * left.x();
  innovation.H[north] = g * earth.curvature().y() * left.y();
  innovation.H[speed] = rate / (1.0 + x[speed_scale]);
  innovation.H[speed_scale] = -ground * rate / (1.0 + x[speed_scale]);
  innovation.H[gyro_bias] = -ground;
  innovation.H[left_bias] = 1.0;
  for (int i = 0; i < 3; ++i) {
    innovation.H[azimuth + i] = g * vertical.dot(axes.col(i).cross(left));
  }
  const double sigma = g * parameters.tilt_sigma;
  innovation.R << sigma * sigma * std::max(1.0, parameters.tilt_time / interval);
  return innovation;
}

}  // namespace maploop::fusion
