#include "estimators/fusion/inertial_input.h"

#include <algorithm>
#include <cmath>

namespace maploop::fusion {
namespace {

// Axes that are not used do not count.
bool repeats(const ImuSample& a, const ImuSample& b, const FusionParameters& parameters) {
  return parameters.uses_six_axes()
             ? a.values() == b.values()
             : a.specific_force_forward == b.specific_force_forward &&
                   a.specific_force_left == b.specific_force_left && a.yaw_rate == b.yaw_rate;
}

// Sets the input to the values between `a` (weight 0) and `b` (1).
void interpolate(const InertialValues& a, const InertialValues& b, double weight,
                 const FusionParameters& parameters, InertialInput& input) {
  const auto between = [&](double InertialValues::*value) {
    return a.*value + weight * (b.*value - a.*value);
  };
  using V = InertialValues;
  input.inertial = true;
  input.forward_force = between(&V::specific_force_forward);
  input.yaw_rate = between(&V::yaw_rate);
  input.six_axes = a.six_axes && b.six_axes && parameters.uses_six_axes();
  if (!input.six_axes) return;
  input.left_force = between(&V::specific_force_left);
  input.roll_rate = between(&V::roll_rate);
  input.pitch_rate = between(&V::pitch_rate);
}

InertialValues change(const InertialValues& a, const InertialValues& b, double seconds) {
  InertialValues per_second;
  using V = InertialValues;
  for (double V::*value : {&V::specific_force_forward, &V::specific_force_left, &V::yaw_rate,
                           &V::roll_rate, &V::pitch_rate}) {
    per_second.*value = (b.*value - a.*value) / seconds;
  }
  return per_second;
}

bool neighbours(const InertialSamples& samples, const FusionParameters& parameters) {
  return samples.before != nullptr && samples.after != nullptr &&
         samples.after->stamp - samples.before->stamp <= from_seconds(parameters.imu_bridge) &&
         !frozen(samples.repeated, parameters) &&
         !repeats(*samples.before, *samples.after, parameters);
}

Time measured(const InertialSamples& samples) {
  return samples.before->stamp - samples.repeated;
}

}  // namespace

InertialInput advanced(InertialInput input, double delay) {
  input.forward_force += delay * input.change.specific_force_forward;
  input.yaw_rate += delay * input.change.yaw_rate;
  input.left_force += delay * input.change.specific_force_left;
  input.roll_rate += delay * input.change.roll_rate;
  input.pitch_rate += delay * input.change.pitch_rate;
  return input;
}

Duration repetition(const InertialSamples& samples, const ImuSample& sample, double speed,
                    const FusionParameters& parameters) {
  if (samples.before == nullptr || !repeats(*samples.before, sample, parameters)) return {};
  if (std::abs(speed) < parameters.repeat_speed && !frozen(samples.repeated, parameters)) return {};
  return samples.repeated + (sample.stamp - samples.before->stamp);
}

bool frozen(Duration repeated, const FusionParameters& parameters) {
  return repeated > from_seconds(parameters.imu_hold);
}

Time end_of_stretch(const InertialSamples& samples, Time from, Time to,
                    const FusionParameters& parameters) {
  Time end = std::min(to, from + from_seconds(parameters.max_step));
  if (samples.before != nullptr && !neighbours(samples, parameters)) {
    const Time held_until = measured(samples) + from_seconds(parameters.imu_hold);
    if (from < held_until) end = std::min(end, held_until);
  }
  return end;
}

InertialInput inertial_input(const InertialSamples& samples, Time from, Time to,
                             const FusionParameters& parameters) {
  InertialInput input;
  input.duration = to_seconds(to - from);
  if (samples.before == nullptr) return input;
  const ImuSample& a = *samples.before;

  if (neighbours(samples, parameters)) {
    // The largest unseen deviation is a triangle between a straight line and a bend in the middle
    // of the gap T. Its area is T^2 / 8 over the whole gap and is spread evenly.
    const ImuSample& b = *samples.after;
    const double gap = to_seconds(b.stamp - a.stamp);
    const double weight = to_seconds((from - a.stamp) + (to - a.stamp)) / (2.0 * gap);
    interpolate(a, b, weight, parameters, input);
    // How the rates change within a silence is not known.
    if (gap <= parameters.imu_hold) input.change = change(a, b, gap);
    input.unseen_change = gap * gap * gap * input.duration / 64.0;  // (1) of METHOD.md
    return input;
  }

  const double age_from = to_seconds(from - measured(samples));
  const double age_to = to_seconds(to - measured(samples));
  if (to - measured(samples) > from_seconds(parameters.imu_hold)) return input;
  // The unseen deviation is a ramp that starts at the sample: age^2 / 2.
  interpolate(a, a, 0.0, parameters, input);
  input.unseen_change = (std::pow(age_to, 4) - std::pow(age_from, 4)) / 4.0;  // (2) of METHOD.md
  return input;
}

}  // namespace maploop::fusion
