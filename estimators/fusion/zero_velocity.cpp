#include "estimators/fusion/zero_velocity.h"

#include <algorithm>
#include <cmath>

namespace maploop::fusion {
namespace {

constexpr double memory = 1.0;  // s, for the statistics and for reports of odometry and wheels

void note(Stillness& stillness, bool standing, Time stamp) {
  (standing ? stillness.seen_standing : stillness.seen_moving) = stamp;
}

}  // namespace

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
  const double deviation = sample.specific_force_forward - s.mean_force;
  s.mean_force += share * deviation;
  s.force_variance = (1.0 - share) * (s.force_variance + share * deviation * deviation);

  const double rate_margin = p.still_rate + 3.0 * std::sqrt(state.P(gyro_bias, gyro_bias));
  if (s.force_variance > p.still_force * p.still_force ||
      std::abs(sample.yaw_rate - state.x[gyro_bias]) > rate_margin) {
    return false;
  }
  const Time recent = sample.stamp - from_seconds(memory);
  if (std::max(s.seen_standing, s.seen_moving) > recent) return s.seen_standing > s.seen_moving;
  return std::abs(state.x[speed]) < p.still_speed &&
         state.P(speed, speed) < p.still_speed * p.still_speed;
}

Innovation<1> zero_velocity_innovation(const FilterState& state, double interval,
                                       const FusionParameters& p) {
  Innovation<1> innovation;
  innovation.residual << -state.x[index::speed];  // (23) of METHOD.md
  innovation.H.setZero();
  innovation.H[index::speed] = 1.0;
  innovation.R << p.zero_velocity_sigma * p.zero_velocity_sigma * std::max(1.0, 0.1 / interval);
  return innovation;
}

Innovation<1> zero_rate_innovation(const FilterState& state, const ImuSample& sample,
                                   double interval, const LocalEarth& earth,
                                   const FusionParameters& p) {
  using namespace index;
  Innovation<1> innovation;
  // (24) of METHOD.md
  innovation.residual << sample.yaw_rate - state.x[gyro_bias] -
                             earth.earth_rate_up() * std::cos(state.x[pitch]) *
                                 std::cos(state.x[roll]);
  innovation.H.setZero();
  innovation.H[gyro_bias] = 1.0;
  innovation.R << p.gyro_noise * p.gyro_noise / interval +
                      p.zero_rate_sigma * p.zero_rate_sigma / interval;
  return innovation;
}

}  // namespace maploop::fusion
