// What the inertial sensors say about a stretch of time between, or after, their samples.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "msgs/imu.h"

namespace maploop::fusion {

struct InertialInput {
  double duration = 0.0;       // s
  bool inertial = false;       // false: the IMU is silent, the rest is zero
  double forward_force = 0.0;  // m/s^2, mean over the stretch
  double yaw_rate = 0.0;       // rad/s, mean over the stretch
  // Variance of the integral over the stretch when its integrand changes by 1 per second (sigma)
  // unseen between or after the samples, s^4.
  double unseen_change = 0.0;
};

// Two neighbouring samples; either may be missing (null).
struct InertialSamples {
  const ImuSample* before = nullptr;
  const ImuSample* after = nullptr;
  Duration repeated{};  // how long `before` has only repeated what was measured earlier
};

// How long `sample`, the one behind `samples.before`, has only repeated what was measured earlier:
// all of its values are the same bits. A vehicle on its way shakes its sensors; slower than
// `repeat_speed` even a healthy unit with coarse steps repeats itself, and a repetition counts as
// measured, but where it goes on from one that was found frozen.
Duration repetition(const InertialSamples& samples, const ImuSample& sample, double speed,
                    const FusionParameters& parameters);

// Repeated for longer than `imu_hold`: the unit is stuck.
bool frozen(Duration repeated, const FusionParameters& parameters);

// End of the part of [from, to] that one InertialInput can describe. Precondition: from < to.
Time end_of_stretch(const InertialSamples& samples, Time from, Time to,
                    const FusionParameters& parameters);

// Linear interpolation between samples not further apart than `imu_bridge`; after a sample without
// such a successor its value is held for `imu_hold`; then the IMU counts as silent. So a sample
// that arrives after a longer silence changes nothing before itself. A sample that repeats the one
// before is no new measurement: the older one is held.
// Across a gap of T what the line misses grows with T^2: on eight KITTI drives the azimuth by 2.9
// deg rms at 1.7 s and 4.3 deg at 2 s, where the yaw acceleration's default says 6.2 and 8.6 deg.
// Precondition: [from, to] ends at or before end_of_stretch.
InertialInput inertial_input(const InertialSamples& samples, Time from, Time to,
                             const FusionParameters& parameters);

}  // namespace maploop::fusion
