#include "estimators/fusion/inertial_update.h"

#include <algorithm>
#include <cmath>

namespace maploop::fusion {
namespace {

constexpr double memory = 1.0;  // s, for the statistics and for reports of odometry and wheels

void note(Stillness& stillness, bool standing, Time stamp) {
  (standing ? stillness.seen_standing : stillness.seen_moving) = stamp;
}

// Updates a mean and a variance over the memory by a new value.
void follow(double& mean, double& variance, double value, double share) {
  const double deviation = value - mean;
  mean += share * deviation;
  variance = (1.0 - share) * (variance + share * deviation * deviation);
}

// Even on a smooth road the tyres and the engine shake a moving vehicle more than this.
bool is_quiet(const Stillness& s, bool six, const FusionParameters& p) {
  if (six && s.roll_rate_variance + s.pitch_rate_variance > 2.0 * p.quiet_rate * p.quiet_rate)
    return false;
  return s.force_variance + s.left_variance < p.quiet_force * p.quiet_force &&
         s.rate_variance < p.quiet_rate * p.quiet_rate;
}

// Returns whether the estimated speed does not contradict a standstill.
bool near_zero(const FilterState& state) {
  constexpr double creep = 0.5;  // m/s
  return std::abs(state.x[index::speed]) <
         creep + 3.0 * std::sqrt(state.P(index::speed, index::speed));
}

}  // namespace

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
  const bool six = sample.six_axes && parameters.uses_six_axes();
  const double acceleration =
      sample.specific_force_forward - x[forward_bias] - g * vertical.dot(R.col(0));
  if (std::abs(acceleration) > parameters.max_acceleration ||
      std::abs(ground * rate) > parameters.max_lateral_acceleration) {
    return std::nullopt;
  }

  const Vector3d left = R.col(1);
  const Eigen::Matrix3d axes = attitude_rate_axes(state.attitude());
  const double sigma = g * (six ? parameters.levelled_tilt_sigma : parameters.tilt_sigma);
  // (20) of METHOD.md
  Innovation<1> innovation(
      sample.specific_force_left - (ground * rate + g * vertical.dot(left) + x[left_bias]),
      sigma * sigma * std::max(1.0, parameters.tilt_time / interval));
  innovation.H[east] = g * earth.curvature().x() * left.x();
  innovation.H[north] = g * earth.curvature().y() * left.y();
  innovation.H[speed] = rate / (1.0 + x[speed_scale]);
  innovation.H[speed_scale] = -ground * rate / (1.0 + x[speed_scale]);
  innovation.H[gyro_bias] = -ground;
  innovation.H[left_bias] = 1.0;
  for (int i = 0; i < 3; ++i) {
    innovation.H[azimuth + i] = g * vertical.dot(axes.col(i).cross(left));
  }
  if (!six) return innovation;
  // (33) of METHOD.md
  innovation.residual[0] += x[unit_course] * sample.specific_force_forward;
  innovation.H[unit_course] = -sample.specific_force_forward;
  return innovation;
}

Innovation<1> up_innovation(const FilterState& state, const ImuSample& sample, double interval,
                            const LocalEarth& earth, const FusionParameters& parameters) {
  using namespace index;
  using Eigen::Vector3d;
  const StateVector& x = state.x;
  const double g = earth.gravity(x[up]);
  const Vector3d vertical = earth.vertical(x[east], x[north]);
  const Vector3d above = rotation_enu_body(state.attitude()).col(2);
  const Eigen::Matrix3d axes = attitude_rate_axes(state.attitude());
  const double sigma = g * parameters.levelled_tilt_sigma;
  // (34) of METHOD.md
  Innovation<1> innovation(sample.specific_force_up - (g * vertical.dot(above) + x[up_bias]),
                           sigma * sigma * std::max(1.0, parameters.tilt_time / interval));
  innovation.H[east] = g * earth.curvature().x() * above.x();
  innovation.H[north] = g * earth.curvature().y() * above.y();
  innovation.H[up_bias] = 1.0;
  for (int i = 0; i < 3; ++i) {
    innovation.H[azimuth + i] = g * vertical.dot(axes.col(i).cross(above));
  }
  return innovation;
}

void note_motion(Stillness& stillness, const RelativeMotion& motion, const FusionParameters& p) {
  if (motion.status != OdometryStatus::ok) return;
  const double way = p.still_speed * to_seconds(motion.stamp - motion.from);
  note(stillness, motion.translation.norm() < way, motion.stamp);
}

void note_motion(Stillness& stillness, const WheelSpeed& sample, const FusionParameters& p) {
  note(stillness, std::abs(sample.speed) < p.still_speed + 2.0 * sample.sigma, sample.stamp);
}

bool stands(FilterState& state, const ImuSample& sample, double interval,
            const FusionParameters& p) {
  using namespace index;
  Stillness& s = state.stillness;
  const double share = 1.0 - std::exp(-interval / memory);
  follow(s.mean_force, s.force_variance, sample.specific_force_forward, share);
  follow(s.mean_left, s.left_variance, sample.specific_force_left, share);
  follow(s.mean_rate, s.rate_variance, sample.yaw_rate, share);
  const bool six = sample.six_axes && p.uses_six_axes();
  if (six) {
    follow(s.mean_roll_rate, s.roll_rate_variance, sample.roll_rate, share);
    follow(s.mean_pitch_rate, s.pitch_rate_variance, sample.pitch_rate, share);
  }

  if (s.denied_until > sample.stamp) return false;
  const double rate_margin = p.still_rate + 3.0 * std::sqrt(state.P(gyro_bias, gyro_bias));
  if (std::abs(sample.yaw_rate - state.x[gyro_bias]) > rate_margin) return false;
  if (p.still_by_inertia && is_quiet(s, six, p)) return near_zero(state);
  if (s.force_variance > p.still_force * p.still_force) return false;
  const Time recent = sample.stamp - from_seconds(memory);
  if (std::max(s.seen_standing, s.seen_moving) > recent) return s.seen_standing > s.seen_moving;
  return std::abs(state.x[speed]) < p.still_speed &&
         state.P(speed, speed) < p.still_speed * p.still_speed;
}

Innovation<1> zero_velocity_innovation(const FilterState& state, double interval,
                                       const FusionParameters& p) {
  // (23) of METHOD.md
  Innovation<1> innovation(-state.x[index::speed], p.zero_velocity_sigma * p.zero_velocity_sigma *
                                                       std::max(1.0, 0.1 / interval));
  innovation.H[index::speed] = 1.0;
  return innovation;
}

Innovation<1> zero_rate_innovation(const FilterState& state, const ImuSample& sample,
                                   double interval, const LocalEarth& earth,
                                   const FusionParameters& p) {
  using namespace index;
  // (24) of METHOD.md
  Innovation<1> innovation(
      sample.yaw_rate - state.x[gyro_bias] -
          earth.earth_rate_up() * std::cos(state.x[pitch]) * std::cos(state.x[roll]),
      p.gyro_noise * p.gyro_noise / interval + p.zero_rate_sigma * p.zero_rate_sigma / interval);
  innovation.H[gyro_bias] = 1.0;
  return innovation;
}

Innovation<1> zero_tilt_rate_innovation(const FilterState& state, const ImuSample& sample, int axis,
                                        double interval, const LocalEarth& earth,
                                        const FusionParameters& p) {
  using namespace index;
  const int bias = axis == 0 ? roll_gyro_bias : pitch_gyro_bias;
  const double rate = axis == 0 ? sample.roll_rate : sample.pitch_rate;
  const double own = rotation_enu_body(state.attitude()).col(axis).dot(earth.earth_rate());
  // (24) of METHOD.md
  Innovation<1> innovation(
      rate - state.x[bias] - own,
      p.gyro_noise * p.gyro_noise / interval + p.zero_rate_sigma * p.zero_rate_sigma / interval);
  innovation.H[bias] = 1.0;
  return innovation;
}

}  // namespace maploop::fusion
