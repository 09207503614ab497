#include "estimators/fusion/mechanization.h"

#include <cmath>

namespace maploop::fusion {
namespace {

using Eigen::Vector3d;

double squared(double v) {
  return v * v;
}

// Direction in enu at an azimuth and an elevation.
Vector3d direction(double azimuth, double elevation) {
  const double c = std::cos(elevation);
  return {std::sin(azimuth) * c, std::cos(azimuth) * c, std::sin(elevation)};
}

}  // namespace

Step mechanize(const StateVector& x, const InertialInput& input, const LocalEarth& earth,
               const FusionParameters& parameters) {
  using namespace index;
  const double dt = input.duration;
  const double sA = std::sin(x[azimuth]), cA = std::cos(x[azimuth]);
  const double sp = std::sin(x[pitch]), cp = std::cos(x[pitch]);
  const double sr = std::sin(x[roll]), cr = std::cos(x[roll]);

  // Azimuth rate and acceleration, and their derivatives (rows over the state).
  double azimuth_rate = 0.0;
  double acceleration = 0.0;
  Eigen::Matrix<double, 1, count> azimuth_rate_by = Eigen::Matrix<double, 1, count>::Zero();
  Eigen::Matrix<double, 1, count> acceleration_by = Eigen::Matrix<double, 1, count>::Zero();
  if (input.inertial) {
    const double rate = input.yaw_rate - x[gyro_bias];
    azimuth_rate = -(rate / (cp * cr) - earth.earth_rate_up());
    azimuth_rate_by[pitch] = -rate * sp / (cp * cp * cr);
    azimuth_rate_by[roll] = -rate * sr / (cp * cr * cr);
    azimuth_rate_by[gyro_bias] = 1.0 / (cp * cr);

    const double g = earth.gravity(x[up]);
    const Vector3d vertical = earth.vertical(x[east], x[north]);
    const Vector3d forward(sA * cp, cA * cp, sp);
    acceleration = input.forward_force - x[forward_bias] - g * vertical.dot(forward);
    acceleration_by[east] = -g * earth.curvature().x() * forward.x();
    acceleration_by[north] = -g * earth.curvature().y() * forward.y();
    acceleration_by[azimuth] = -g * vertical.dot(Vector3d(cA * cp, -sA * cp, 0.0));
    acceleration_by[pitch] = -g * vertical.dot(Vector3d(-sA * sp, -cA * sp, cp));
    acceleration_by[forward_bias] = -1.0;
  }

  const double mid_azimuth = x[azimuth] + 0.5 * dt * azimuth_rate;
  const double mid_speed = x[speed] + 0.5 * dt * acceleration;
  const double climb = x[pitch] + x[climb_offset];
  const Vector3d travel = direction(mid_azimuth, climb);
  const Vector3d travel_by_azimuth(travel.y(), -travel.x(), 0.0);
  const Vector3d travel_by_climb(-std::sin(mid_azimuth) * std::sin(climb),
                                 -std::cos(mid_azimuth) * std::sin(climb), std::cos(climb));

  Step step;
  step.x = x;
  step.x.segment<3>(east) += dt * mid_speed * travel;
  step.x[speed] += dt * acceleration;
  step.x[azimuth] = wrap_angle(x[azimuth] + dt * azimuth_rate);
  step.x[distance] += dt * mid_speed;

  StateMatrix& F = step.F;
  F.setIdentity();
  F.middleRows<3>(east) += dt * travel * (0.5 * dt * acceleration_by) +
                           dt * mid_speed * travel_by_azimuth * (0.5 * dt * azimuth_rate_by);
  F.block<3, 1>(east, speed) += dt * travel;
  F.block<3, 1>(east, azimuth) += dt * mid_speed * travel_by_azimuth;
  F.block<3, 1>(east, pitch) += dt * mid_speed * travel_by_climb;
  F.block<3, 1>(east, climb_offset) += dt * mid_speed * travel_by_climb;
  F.row(speed) += dt * acceleration_by;
  F.row(azimuth) += dt * azimuth_rate_by;
  F.row(distance) += 0.5 * dt * dt * acceleration_by;
  F(distance, speed) += dt;
  const auto decay = [&](int i, double time, double mean = 0.0) {
    const double factor = std::exp(-dt / time);
    step.x[i] = mean + (step.x[i] - mean) * factor;
    F(i, i) = factor;
  };
  decay(gyro_bias, parameters.gyro_bias_time);
  decay(forward_bias, parameters.accelerometer_bias_time);
  decay(left_bias, parameters.accelerometer_bias_time);
  decay(climb_offset, parameters.climb_offset_time, parameters.climb_offset);
  decay(odometry_scale, parameters.odometry_scale_time);

  step.acceleration_effect.setZero();
  step.acceleration_effect.segment<3>(east) = 0.5 * dt * dt * travel;
  step.acceleration_effect[speed] = dt;
  step.acceleration_effect[distance] = 0.5 * dt * dt;
  step.yaw_rate_effect.setZero();
  step.yaw_rate_effect[azimuth] = -dt / (cp * cr);
  step.yaw_rate_effect.segment<3>(east) =
      -0.5 * dt * dt * mid_speed / (cp * cr) * travel_by_azimuth;
  return step;
}

StateMatrix process_noise(const StateVector& x, const Step& step, const InertialInput& input,
                          const FusionParameters& p) {
  using namespace index;
  const double dt = input.duration;
  StateMatrix Q = StateMatrix::Zero();

  // White noise of density q is a constant error of variance q / dt over the step.
  double speed_variance = dt * squared(p.silent_speed_noise);
  double azimuth_variance = dt * squared(p.silent_yaw_noise);
  if (input.inertial) {
    speed_variance = dt * squared(p.acceleration_noise) + input.unseen_change * squared(p.jerk);
    azimuth_variance =
        dt * (squared(p.gyro_noise) + squared(p.gyro_scale_sigma * input.yaw_rate) * p.turn_time) +
        input.unseen_change * squared(p.yaw_acceleration);
  }
  Q += step.acceleration_effect * step.acceleration_effect.transpose() *
       (speed_variance / (dt * dt));
  Q += step.yaw_rate_effect * step.yaw_rate_effect.transpose() * (azimuth_variance / (dt * dt));

  Q(pitch, pitch) += dt * squared(p.pitch_noise);
  Q(roll, roll) += dt * squared(p.roll_noise);

  const auto walk = [&](int i, double sigma) {
    Q(i, i) += squared(sigma) * (1.0 - squared(step.F(i, i)));
  };
  walk(gyro_bias, p.gyro_bias_sigma);
  walk(forward_bias, p.accelerometer_bias_sigma);
  walk(left_bias, p.accelerometer_bias_sigma);
  walk(climb_offset, p.climb_offset_sigma);
  walk(odometry_scale, p.odometry_scale_sigma);

  // Side slip and suspension turn the direction of travel away from the body's axis.
  const Vector3d travel = direction(x[azimuth], x[pitch] + x[climb_offset]);
  Q.block<3, 3>(east, east) += dt * squared(x[speed] * p.slip_sigma) * p.slip_time *
                               (Eigen::Matrix3d::Identity() - travel * travel.transpose());
  return Q;
}

void predict(FilterState& state, const InertialInput& input, const LocalEarth& earth,
             const FusionParameters& parameters) {
  const Step step = mechanize(state.x, input, earth, parameters);
  const StateMatrix FP = step.F * state.P;
  StateMatrix P = FP * step.F.transpose();
  P += process_noise(state.x, step, input, parameters);
  state.P = 0.5 * (P + P.transpose());
  state.x = step.x;
}

}  // namespace maploop::fusion
