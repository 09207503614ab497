// This file defines a sample of an inertial unit: of the reduced one, which has two horizontal
// accelerometers and one vertical gyro, or of a full one with three of each.
#pragma once

#include "msgs/sample.h"

namespace maploop {

// What the unit measures in the body's axes: x forward, y left, z up. Specific forces contain
// gravity, so that a unit which stands level measures 9.8 m/s^2 up.
struct InertialValues {
  double specific_force_forward = 0.0;  // m/s^2
  double specific_force_left = 0.0;     // m/s^2
  double yaw_rate = 0.0;                // rad/s about body z, positive when turning left
  bool six_axes = false;           // whether the unit measures the values below; else they are 0
  double specific_force_up = 0.0;  // m/s^2
  double roll_rate = 0.0;          // rad/s about body x, positive when the right side goes down
  double pitch_rate = 0.0;         // rad/s about body y, positive when the nose goes down

  bool operator==(const InertialValues&) const = default;  // exact
};

// This is what the unit measured at `stamp`.
struct ImuSample : Sample, InertialValues {
  // Returns the measured values without the stamps.
  const InertialValues& values() const { return *this; }
  // Returns the same, for writing.
  InertialValues& values() { return *this; }

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), specific_force_forward, specific_force_left, yaw_rate, six_axes,
       specific_force_up, roll_rate, pitch_rate);
  }
};

}  // namespace maploop
