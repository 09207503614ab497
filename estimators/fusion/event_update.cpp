#include "estimators/fusion/event_update.h"

#include <cmath>

#include "estimators/fusion/gnss_update.h"
#include "estimators/fusion/inertial_update.h"
#include "estimators/fusion/map_update.h"
#include "estimators/fusion/mechanization.h"
#include "estimators/fusion/odometry_update.h"
#include "estimators/fusion/velocity_witness.h"
#include "estimators/fusion/wheel_update.h"

namespace maploop::fusion {
namespace {

constexpr double tight_turn = 0.1;  // rad/s

// Interpolates linearly between samples, of what was measured `delay` seconds later; after the
// newest one, returns its own value.
double yaw_rate_at(const InertialSamples& samples, Time t, double delay) {
  if (samples.before == nullptr) return 0.0;
  const ImuSample& a = *samples.before;
  if (samples.after == nullptr) return a.yaw_rate;
  const double gap = to_seconds(samples.after->stamp - a.stamp);
  const double share = gap > 0.0 ? (to_seconds(t - a.stamp) + delay) / gap : 0.0;
  return a.yaw_rate + share * (samples.after->yaw_rate - a.yaw_rate);
}

// Applies what a sample shows besides the prediction: the roll from gravity, and standstill.
void apply_sample(FilterState& state, const ImuSample& sample, const ImuSample& before,
                  const LocalEarth& earth, const FusionParameters& p) {
  const double interval = to_seconds(sample.stamp - before.stamp);
  if (interval <= 0.0) return;
  const bool six = sample.six_axes && p.uses_six_axes();
  if (const auto roll = roll_innovation(state, sample, interval, earth, p)) {
    // A body leans in turns; the effect on the measured force must not change turning, nor the
    // speed where a sensor measures it. Wide curves are banked, so they do not show the speed.
    const bool turns = six || std::abs(sample.yaw_rate - state.x[index::gyro_bias]) > tight_turn;
    // A state that is listed twice is considered once.
    const int speed = p.speed_from_turns && turns ? index::speed_scale : index::speed;
    joseph_update(
        state.x, state.P, *roll,
        {speed, index::speed_scale, index::gyro_bias, index::lidar_scale, index::lidar_turn});
  }
  if (!stands(state, sample, interval, p) || !p.use_zero_velocity) return;
  joseph_update(state.x, state.P, zero_velocity_innovation(state, interval, p));
  joseph_update(state.x, state.P, zero_rate_innovation(state, sample, interval, earth, p));
  if (six) {
    for (const int axis : {0, 1}) {
      joseph_update(state.x, state.P,
                    zero_tilt_rate_innovation(state, sample, axis, interval, earth, p));
    }
    joseph_update(state.x, state.P, up_innovation(state, sample, interval, earth, p));
  }
  state.zero_velocity_stamp = sample.stamp;
}

}  // namespace

void advance(FilterState& state, const InertialSamples& samples, Time to, const LocalEarth& earth,
             const FusionParameters& p) {
  if (to > state.stamp) state.yaw_rate = yaw_rate_at(samples, to, state.x[index::imu_delay]);
  while (state.stamp < to) {
    const Time end = end_of_stretch(samples, state.stamp, to, p);
    predict(state, inertial_input(samples, state.stamp, end, p), earth, p);
    state.stamp = end;
  }
}

Outcome apply_event(FilterState& state, const Event& event, const InertialSamples& samples,
                    const LocalFrame& frame, const LocalEarth& earth, const FusionParameters& p) {
  if (const auto* motion = std::get_if<RelativeMotion>(&event.measurement)) {
    const Outcome outcome = apply_odometry(state, *motion, p);
    if (!outcome.refused()) note_motion(state.stillness, *motion, p);
    return outcome;
  }
  if (const auto* sample = std::get_if<ImuSample>(&event.measurement)) {
    state.imu_repeated = repetition(samples, *sample, state.x[index::speed], p);
    if (frozen(state.imu_repeated, p)) return refused(Reason::frozen);
    if (samples.before != nullptr) apply_sample(state, *sample, *samples.before, earth, p);
    state.imu_stamp = sample->stamp;
    return {};
  }
  if (const auto* sample = std::get_if<WheelSpeed>(&event.measurement)) {
    const Outcome outcome = apply_wheel(state, *sample, p);
    if (!outcome.refused()) note_motion(state.stillness, *sample, p);
    return outcome;
  }
  if (const auto* fix = std::get_if<GnssFix>(&event.measurement)) {
    // Without odometry, the fix must not move the frame of odometry.
    if (state.stamp - state.clone_stamp > from_seconds(p.max_interval)) take_clone(state);
    const bool of_velocity = event.key.kind == EventKind::gnss_velocity;
    if (of_velocity) judge_by_velocity(state, *fix, frame, p);
    const FixBefore& newest = state.fix_before;
    if (newest.repeats && newest.stamp == fix->velocity_stamp) return refused(Reason::frozen);
    if (!of_velocity) {
      return apply_gnss_position(state, *fix, frame, p);
    }
    const bool known = samples.before != nullptr && !frozen(samples.repeated, p);
    return apply_gnss_velocity(state, *fix, known ? samples.before->yaw_rate : 0.0, p);
  }
  if (const auto* feedback = std::get_if<MapFeedback>(&event.measurement)) {
    return apply_map(state, *feedback, frame, p);
  }
  take_clone(state);
  return {};
}

}  // namespace maploop::fusion
