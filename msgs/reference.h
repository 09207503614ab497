// This file defines the reference ("truth") of a recorded drive. It is never an input of an
// estimator.
#pragma once

#include <Eigen/Core>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "msgs/sample.h"

namespace maploop {

// This is the reference for the pose and the velocity of the body. `stamp` is that of the position
// and the attitude.
struct ReferencePose : Sample {
  Geodetic position;      // of the body's origin
  Attitude attitude;      // of the body
  Time velocity_stamp{};  // some recorders give a velocity older than the position
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  // m/s
  double position_accuracy = 0.0;                          // m, as the recorder states it

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), position, attitude, velocity_stamp, velocity_enu,
       position_accuracy);
  }
};

}  // namespace maploop
