// This file adds noise to a good inertial unit's samples so that they resemble a cheaper unit's.
#pragma once

#include <cstdint>
#include <memory>

#include "msgs/imu.h"
#include "sensors/source.h"

namespace maploop::sensors {

struct ImuNoiseParameters {
  double gyro_turn_on = 0.0;           // rad/s, 1 sigma, constant from the start
  double gyro_instability = 0.0;       // rad/s, 1 sigma, first-order Gauss-Markov
  double instability_time = 300.0;     // s, correlation time of the instability
  double gyro_white = 0.0;             // rad/sqrt(s), angle random walk
  double gyro_scale = 0.0;             // 1, 1 sigma, constant
  double accelerometer_turn_on = 0.0;  // m/s^2, 1 sigma an axis, constant
  std::int64_t seed = 1;
};

// Returns the noise of an automotive MEMS unit: 300 deg/h turn-on, 10 deg/h instability, 0.3
// deg/sqrt(h), 0.2 % scale; accelerometers 20 mg turn-on.
ImuNoiseParameters mems_noise(std::int64_t seed);

// Returns the same with each size times 0.5 to 2, as units of one kind differ, and an
// instability_time of 50 to 1000 s; the seed draws all of them log-uniformly.
ImuNoiseParameters drawn(const ImuNoiseParameters& parameters);

// Returns the same samples with noise added, which depends only on the seed and the stamps.
std::unique_ptr<Source<ImuSample>> with_noise(std::unique_ptr<Source<ImuSample>> source,
                                              const ImuNoiseParameters& parameters);

}  // namespace maploop::sensors
