// The inertial samples are turned here into the mean inertial input over a stretch of time.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "msgs/imu.h"

namespace maploop::fusion {

struct InertialInput {
  double duration = 0.0;       // s
  bool inertial = false;       // false: the IMU is silent, the rest is zero
  double forward_force = 0.0;  // m/s^2, mean over the stretch
  double yaw_rate = 0.0;       // rad/s, mean over the stretch
  // The other values are means, too, of a full unit that the filter uses as one.
  bool six_axes = false;
  double left_force = 0.0;                   // m/s^2
  double roll_rate = 0.0, pitch_rate = 0.0;  // rad/s about body x and y
  InertialValues change;                     // of all values per second, between the samples
  // This is the variance (s^4) of the integral over the stretch if the integrand changes
  // unobserved, between or after the samples, with a rate of sigma 1 per second.
  double unseen_change = 0.0;
};

// Returns the input that was measured `delay` seconds later, to first order.
InertialInput advanced(InertialInput input, double delay);

// These are two consecutive samples; either may be missing (null).
struct InertialSamples {
  const ImuSample* before = nullptr;
  const ImuSample* after = nullptr;
  Duration repeated{};  // how long `before` has only repeated older values
};

// Returns how long `sample`, which follows `samples.before`, has only repeated earlier values bit
// by bit. A moving vehicle shakes its sensors; below `repeat_speed` (`speed` in m/s) a healthy unit
// with coarse steps may repeat itself too. There a repetition counts as measured unless the values
// were already frozen.
Duration repetition(const InertialSamples& samples, const ImuSample& sample, double speed,
                    const FusionParameters& parameters);

// Returns whether values repeated for longer than `imu_hold`, which means that the unit is stuck.
bool frozen(Duration repeated, const FusionParameters& parameters);

// Returns the end of the part of [from, to], starting at `from`, that one InertialInput can
// describe. Precondition: from < to.
Time end_of_stretch(const InertialSamples& samples, Time from, Time to,
                    const FusionParameters& parameters);

// Interpolates linearly between samples that are at most `imu_bridge` apart. A sample without such
// a successor is held for `imu_hold`; then the IMU counts as silent. A sample that arrives after a
// longer silence therefore changes nothing before its own stamp. A sample that repeats the one
// before is not a new measurement: the older one is held.
// In a gap of length T the interpolation error grows with T^2: on eight KITTI drives the azimuth
// error is 2.9 deg rms at 1.7 s and 4.3 deg at 2 s; the default yaw acceleration predicts 6.2 and
// 8.6 deg.
// Precondition: [from, to] ends at or before end_of_stretch.
InertialInput inertial_input(const InertialSamples& samples, Time from, Time to,
                             const FusionParameters& parameters);

}  // namespace maploop::fusion
