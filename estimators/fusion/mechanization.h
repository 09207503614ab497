// Reduced-IMU mechanization: forward speed, one gyro, position in local metres
// (Noureldin, Karamat and Georgy 2013, 3D-RISS). The vehicle travels along its azimuth,
// climbing by its pitch and the offset between body x and the direction of travel.
#pragma once

#include "estimators/fusion/earth.h"
#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/inertial_input.h"

namespace maploop::fusion {

// One step of the nominal state and what its covariance needs.
struct Step {
  StateVector x;
  StateMatrix F;                    // of x by the state before
  StateVector acceleration_effect;  // of x by a constant error of the acceleration, 1/(m/s^2)
  StateVector yaw_rate_effect;      // of x by a constant error of the yaw rate, 1/(rad/s)
};

// The state `input.duration` later, by the midpoint rule. The specific forces contain gravity; the
// Earth's rotation is taken out of the gyro. Without inertial data speed and attitude stay.
Step mechanize(const StateVector& x, const InertialInput& input, const LocalEarth& earth,
               const FusionParameters& parameters);

// Covariance of what the step cannot know (white noise of the inertial sensors, their biases'
// walk, road, suspension and side slip) over its duration.
StateMatrix process_noise(const StateVector& x, const Step& step, const InertialInput& input,
                          const FusionParameters& parameters);

// Carries state and covariance to the end of the input's stretch. The stamp is the caller's.
void predict(FilterState& state, const InertialInput& input, const LocalEarth& earth,
             const FusionParameters& parameters);

}  // namespace maploop::fusion
