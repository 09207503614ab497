// This is the reduced-IMU mechanization: forward speed, one gyro, position in local metres
// (Noureldin, Karamat and Georgy 2013, 3D-RISS). The vehicle travels along its azimuth. Its climb
// angle is its pitch plus the offset between body x and the direction of travel.
#pragma once

#include "estimators/fusion/attitude_rates.h"
#include "estimators/fusion/earth.h"
#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/inertial_input.h"

namespace maploop::fusion {

// Holds one step of the nominal state and the derivatives that propagate its covariance.
struct Step {
  StateVector x;
  StateMatrix F;                    // derivative of x with respect to the state before
  StateVector acceleration_effect;  // of x per constant acceleration error, 1/(m/s^2)
  StateVector yaw_rate_effect;      // of x per constant yaw rate error, 1/(rad/s)
  Eigen::Matrix3d gyro_effect;      // of the attitude per error of the rate about body x, y, z
};

// Returns the state `input.duration` later by the midpoint rule. The specific forces contain
// gravity, and the Earth's rotation is removed from the gyro. Without inertial data, speed and
// attitude do not change.
Step mechanize(const StateVector& x, const InertialInput& measured, const LocalEarth& earth,
               const FusionParameters& parameters);

// Returns the covariance of the step's noise over its duration: white noise of the inertial
// sensors, random walk of their biases, road, suspension and side slip.
StateMatrix process_noise(const StateVector& x, const Step& step, const InertialInput& input,
                          const FusionParameters& parameters);

// Propagates state and covariance to the end of the input's stretch. The caller sets the stamp.
void predict(FilterState& state, const InertialInput& input, const LocalEarth& earth,
             const FusionParameters& parameters);

}  // namespace maploop::fusion
