#include "estimators/fusion/mechanization.h"

#include <cmath>

#include "estimators/fusion/swing.h"

namespace maploop::fusion {
namespace {

using Eigen::Vector3d;

double squared(double v) {
  return v * v;
}

// Returns F P F^T. Only the first `dense` rows of F, and that of distance, have entries off the
// diagonal, so this takes a third of the full product's operations.
template <int dense>
StateMatrix propagated(const StateMatrix& P, const StateMatrix& F) {
  using namespace index;
  const auto diagonal = F.diagonal();
  StateMatrix FP = diagonal.asDiagonal() * P;
  FP.topRows<dense>().noalias() = F.topRows<dense>() * P;
  FP.row(distance).noalias() = F.row(distance) * P;
  StateMatrix result = FP * diagonal.asDiagonal();
  result.leftCols<dense>().noalias() = FP * F.topRows<dense>().transpose();
  result.col(distance).noalias() = FP * F.row(distance).transpose();
  return 0.5 * (result + result.transpose());
}

struct Acceleration {
  double value = 0.0;  // m/s^2, of the speed
  Eigen::Matrix<double, 1, index::count> by_state = Eigen::Matrix<double, 1, index::count>::Zero();
};

Acceleration acceleration_of(const StateVector& x, const InertialInput& input,
                             const LocalEarth& earth) {
  using namespace index;
  const double sA = std::sin(x[azimuth]), cA = std::cos(x[azimuth]);
  const double sp = std::sin(x[pitch]), cp = std::cos(x[pitch]);
  const double g = earth.gravity(x[up]);
  const Vector3d vertical = earth.vertical(x[east], x[north]);
  const Vector3d forward(sA * cp, cA * cp, sp);
  Acceleration a;
  // (3) of METHOD.md
  a.value = input.forward_force - x[forward_bias] - g * vertical.dot(forward);
  a.by_state[east] = -g * earth.curvature().x() * forward.x();
  a.by_state[north] = -g * earth.curvature().y() * forward.y();
  a.by_state[azimuth] = -g * vertical.dot(Vector3d(cA * cp, -sA * cp, 0.0));
  a.by_state[pitch] = -g * vertical.dot(Vector3d(-sA * sp, -cA * sp, cp));
  a.by_state[forward_bias] = -1.0;
  a.by_state[imu_delay] = input.change.specific_force_forward;
  if (!input.six_axes) return a;
  // (31) of METHOD.md
  const double rate = input.yaw_rate - x[gyro_bias];
  a.value += x[axle_distance] * rate * rate - x[unit_course] * input.left_force;
  a.by_state[axle_distance] = rate * rate;
  a.by_state[gyro_bias] = -2.0 * x[axle_distance] * rate;
  a.by_state[unit_course] = -input.left_force;
  a.by_state[imu_delay] += 2.0 * x[axle_distance] * rate * input.change.yaw_rate -
                           x[unit_course] * input.change.specific_force_left;
  return a;
}

}  // namespace

Step mechanize(const StateVector& x, const InertialInput& measured, const LocalEarth& earth,
               const FusionParameters& parameters) {
  using namespace index;
  const InertialInput input = advanced(measured, x[imu_delay]);  // (25) of METHOD.md
  const double dt = input.duration;
  const double rate = input.inertial ? input.yaw_rate - x[gyro_bias] : 0.0;  // rad/s, body up
  AttitudeRates turning;
  Acceleration forward;
  if (input.inertial) {
    turning = attitude_rates(x, input, earth);
    forward = acceleration_of(x, input, earth);
  }
  const double azimuth_rate = turning.value[0];
  const auto azimuth_rate_by = turning.by_state.row(0);
  const double acceleration = forward.value;
  const auto& acceleration_by = forward.by_state;

  const double mid_azimuth = x[azimuth] + 0.5 * dt * azimuth_rate;
  // Speed and distance are those of the speed sensor; dividing by its scale gives the path over
  // ground. (The effect of the scale on an acceleration is smaller than the accelerometer's own
  // errors.)
  const double sensed_speed = x[speed] + 0.5 * dt * acceleration;
  const double to_ground = 1.0 / (1.0 + x[speed_scale]);
  const double mid_speed = sensed_speed * to_ground;
  const double climb = x[pitch] + x[climb_offset];
  const Vector3d travel = direction(mid_azimuth, climb);
  const Vector3d travel_by_azimuth(travel.y(), -travel.x(), 0.0);
  const Vector3d travel_by_climb(-std::sin(mid_azimuth) * std::sin(climb),
                                 -std::cos(mid_azimuth) * std::sin(climb), std::cos(climb));

  Step step;
  step.x = x;
  step.x.segment<3>(east) += dt * mid_speed * travel;  // (3) of METHOD.md
  const Vector3d left(-std::cos(mid_azimuth), std::sin(mid_azimuth), 0.0);
  const double arm = swing_arm(x);
  const double swing = rate * arm;
  step.x.segment<3>(east) += dt * swing * left;
  step.x[speed] += dt * acceleration;
  step.x[azimuth] = wrap_angle(x[azimuth] + dt * azimuth_rate);
  step.x.segment<2>(pitch) += dt * turning.value.tail<2>();
  step.x[distance] += dt * sensed_speed;

  StateMatrix& F = step.F;
  F.setIdentity();
  F.middleRows<3>(east) += dt * to_ground * travel * (0.5 * dt * acceleration_by) +
                           dt * mid_speed * travel_by_azimuth * (0.5 * dt * azimuth_rate_by);
  F.block<3, 1>(east, speed) += dt * to_ground * travel;
  F.block<3, 1>(east, speed_scale) -= dt * mid_speed * to_ground * travel;
  F.block<3, 1>(east, azimuth) += dt * mid_speed * travel_by_azimuth;
  F.block<3, 1>(east, pitch) += dt * mid_speed * travel_by_climb;
  F.block<3, 1>(east, climb_offset) += dt * mid_speed * travel_by_climb;
  add_swing_derivatives(x, dt * rate * left, F.middleRows<3>(east));
  const Vector3d left_by_azimuth(std::sin(mid_azimuth), std::cos(mid_azimuth), 0.0);
  F.middleRows<3>(east) += dt * swing * left_by_azimuth * (0.5 * dt * azimuth_rate_by);
  F.block<3, 1>(east, azimuth) += dt * swing * left_by_azimuth;
  if (input.inertial) {
    F.block<3, 1>(east, gyro_bias) -= dt * arm * left;
    F.block<3, 1>(east, imu_delay) += dt * arm * input.change.yaw_rate * left;
  }
  F.row(speed) += dt * acceleration_by;
  F.middleRows<3>(azimuth) += dt * turning.by_state;
  F.row(distance) += 0.5 * dt * dt * acceleration_by;
  F(distance, speed) += dt;
  const auto decay = [&](int i, double time, double mean = 0.0) {
    const double factor = std::exp(-dt / time);
    step.x[i] = mean + (step.x[i] - mean) * factor;
    F(i, i) = factor;
  };
  decay(climb_offset, parameters.climb_offset_time, parameters.climb_offset);
  for (int i = gnss_offset_east; i <= gnss_offset_up; ++i) decay(i, parameters.gnss_offset_time);
  // The lane offset decays with distance, not with time.
  const double lane = std::exp(-dt * std::abs(x[speed]) / parameters.lane_length);
  step.x[lane_offset] *= lane;
  F(lane_offset, lane_offset) = lane;

  step.acceleration_effect.setZero();
  step.acceleration_effect.segment<3>(east) = 0.5 * dt * dt * to_ground * travel;
  step.acceleration_effect[speed] = dt;
  step.acceleration_effect[distance] = 0.5 * dt * dt;
  step.gyro_effect = dt * turning.by_gyro;
  step.yaw_rate_effect.setZero();
  if (input.six_axes) {
    step.yaw_rate_effect = -F.col(gyro_bias);
    step.yaw_rate_effect[gyro_bias] = 0.0;
    return step;
  }
  step.yaw_rate_effect[azimuth] = -dt / turning.level;
  step.yaw_rate_effect.segment<3>(east) =
      -0.5 * dt * dt / turning.level * (mid_speed * travel_by_azimuth + swing * left_by_azimuth) +
      dt * arm * left;
  return step;
}

namespace {

// The gyros about body x and y have their own noise, and see a share of the turning, which stays
// the same for a turn.
void add_tilt_noise(StateMatrix& Q, const Step& step, const InertialInput& input,
                    const FusionParameters& p) {
  // (32) of METHOD.md
  const double dt = input.duration;
  const double share = squared(p.cross_axis_sigma * input.yaw_rate) * p.turn_time;
  const double variance = (dt * (squared(p.tilt_rate_noise) + share) +
                           input.unseen_change * squared(p.yaw_acceleration)) /
                          (dt * dt);
  for (int i = 0; i < 2; ++i) {
    Q.block<3, 3>(index::azimuth, index::azimuth) +=
        variance * step.gyro_effect.col(i) * step.gyro_effect.col(i).transpose();
  }
}

}  // namespace

StateMatrix process_noise(const StateVector& x, const Step& step, const InertialInput& input,
                          const FusionParameters& p) {
  using namespace index;
  const double dt = input.duration;
  StateMatrix Q = StateMatrix::Zero();

  // White noise of density q equals a constant error of variance q / dt over the step.
  double speed_variance = dt * squared(p.silent_speed_noise);  // (5) and (6) of METHOD.md
  double azimuth_variance = dt * squared(p.silent_yaw_noise);
  if (input.inertial) {
    const double noise = input.six_axes ? p.levelled_acceleration_noise : p.acceleration_noise;
    speed_variance = dt * squared(noise) + input.unseen_change * squared(p.jerk);
    azimuth_variance =
        dt * (squared(p.gyro_noise) + squared(p.gyro_scale_sigma * input.yaw_rate) * p.turn_time) +
        input.unseen_change * squared(p.yaw_acceleration);
  }
  Q += step.acceleration_effect * step.acceleration_effect.transpose() *
       (speed_variance / (dt * dt));
  Q += step.yaw_rate_effect * step.yaw_rate_effect.transpose() * (azimuth_variance / (dt * dt));

  if (input.six_axes) {
    add_tilt_noise(Q, step, input, p);
  } else {
    Q(pitch, pitch) += dt * squared(p.pitch_noise);
    Q(roll, roll) += dt * squared(p.roll_noise);
  }

  // This random walk departs from a constant by sigma in half of `time`.
  const auto walk = [&](int i, double sigma, double time) {  // (9) of METHOD.md
    Q(i, i) += 2.0 * squared(sigma) * dt / time;
  };
  walk(gyro_bias, p.gyro_bias_sigma, p.gyro_bias_time);
  walk(forward_bias, p.accelerometer_bias_sigma, p.accelerometer_bias_time);
  walk(left_bias, p.accelerometer_bias_sigma, p.accelerometer_bias_time);
  if (input.six_axes) {
    walk(roll_gyro_bias, p.gyro_bias_sigma, p.gyro_bias_time);
    walk(pitch_gyro_bias, p.gyro_bias_sigma, p.gyro_bias_time);
    walk(unit_course, 0.1 * p.unit_course_sigma, p.accelerometer_bias_time);
    walk(up_bias, p.accelerometer_bias_sigma, p.accelerometer_bias_time);
  }
  walk(imu_delay, 0.1 * p.imu_delay_sigma, p.accelerometer_bias_time);
  walk(gnss_delay, 0.1 * p.gnss_delay_sigma, p.accelerometer_bias_time);
  walk(lidar_scale, p.lidar_scale_sigma, p.lidar_error_time);
  walk(lidar_turn, p.lidar_turn_sigma, p.lidar_error_time);
  Q(speed_scale, speed_scale) += dt * squared(p.speed_scale_walk);
  Q(odometry_course, odometry_course) += dt * squared(p.odometry_course_walk);
  Q(chain_drift, chain_drift) += squared(p.chain_drift) * std::abs(x[speed]) * dt;
  // This is a first-order Gauss-Markov process about its mean.
  const auto markov = [&](int i, double sigma) {  // (8) of METHOD.md
    Q(i, i) += squared(sigma) * (1.0 - squared(step.F(i, i)));
  };
  markov(climb_offset, p.climb_offset_sigma);
  for (int i = gnss_offset_east; i <= gnss_offset_up; ++i) markov(i, 1.0);
  markov(lane_offset, 1.0);

  // Side slip turns the direction of travel away from the body's axis, and so do the springs.
  const Vector3d travel = direction(x[azimuth], x[pitch] + x[climb_offset]);
  const Vector3d left(-std::cos(x[azimuth]), std::sin(x[azimuth]), 0.0);
  const Vector3d above = travel.cross(left);
  const double way_variance = dt * squared(x[speed]) * p.slip_time;
  Q.block<3, 3>(east, east) +=  // (7) of METHOD.md
      way_variance * (squared(p.slip_sigma) * left * left.transpose() +
                      squared(p.heave_sigma) * above * above.transpose());
  return Q;
}

void predict(FilterState& state, const InertialInput& input, const LocalEarth& earth,
             const FusionParameters& parameters) {
  const Step step = mechanize(state.x, input, earth, parameters);
  static_assert(index::east == 0 && index::azimuth == 4 && index::roll == 6);
  state.P = input.six_axes ? propagated<index::roll + 1>(state.P, step.F)
                           : propagated<index::azimuth + 1>(state.P, step.F);  // (4) of METHOD.md
  state.P += process_noise(state.x, step, input, parameters);
  if (input.inertial) {
    // A delay of fixes needs the mean over about its own length, without the road's unevenness.
    constexpr double recent = 0.15;  // s
    const double change = step.x[index::speed] - state.x[index::speed];
    const double kept = std::exp(-input.duration / recent);
    state.acceleration = kept * state.acceleration + (1.0 - kept) * change / input.duration;
  } else {
    state.acceleration = 0.0;
  }
  state.x = step.x;
}

}  // namespace maploop::fusion
