#include "estimators/fusion/inertial_input.h"

#include <algorithm>

namespace maploop::fusion {
namespace {

bool neighbours(const InertialSamples& samples, const FusionParameters& parameters) {
  return samples.before != nullptr && samples.after != nullptr &&
         samples.after->stamp - samples.before->stamp <= from_seconds(parameters.imu_hold);
}

}  // namespace

Time end_of_stretch(const InertialSamples& samples, Time from, Time to,
                    const FusionParameters& parameters) {
  Time end = std::min(to, from + from_seconds(parameters.max_step));
  if (samples.before != nullptr && !neighbours(samples, parameters)) {
    const Time held_until = samples.before->stamp + from_seconds(parameters.imu_hold);
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
    // A random walk pinned at both ends (Brownian bridge): its integral over the whole gap T has
    // variance T^3 / 12, spread evenly.
    const ImuSample& b = *samples.after;
    const double gap = to_seconds(b.stamp - a.stamp);
    const double weight = to_seconds((from - a.stamp) + (to - a.stamp)) / (2.0 * gap);
    input.inertial = true;
    input.forward_force =
        a.specific_force_forward + weight * (b.specific_force_forward - a.specific_force_forward);
    input.yaw_rate = a.yaw_rate + weight * (b.yaw_rate - a.yaw_rate);
    input.gap_cubed = gap * gap * input.duration / 12.0;
    return input;
  }

  const double age_from = to_seconds(from - a.stamp);
  const double age_to = to_seconds(to - a.stamp);
  if (to - a.stamp > from_seconds(parameters.imu_hold)) return input;
  // A random walk from the sample on: the integral's variance grows as age^3 / 3.
  input.inertial = true;
  input.forward_force = a.specific_force_forward;
  input.yaw_rate = a.yaw_rate;
  input.gap_cubed = (age_to * age_to * age_to - age_from * age_from * age_from) / 3.0;
  return input;
}

}  // namespace maploop::fusion
