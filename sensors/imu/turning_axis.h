// This file finds the vertical of a vehicle in the axes of an inertial unit, from its gyros alone.
#pragma once

#include <Eigen/Core>

namespace maploop::sensors {

// A vehicle on wheels turns about its vertical: what its gyros measure grows with the rate of its
// course along that axis of the unit. The constant errors of the accelerometers, which tilt the
// level that gravity shows, are no part of it. Leaning in turns and slopes cancel over turns to
// both sides and rounds of a block.
class TurningAxis {
 public:
  // `rate` (rad/s, in the unit's axes) is the mean of an interval, and `course_rate` (rad/s, to the
  // left) what a receiver saw of it.
  void add(const Eigen::Vector3d& rate, double course_rate, double weight);

  // The line through all intervals: rate = bias + course_rate * axis.
  struct Line {
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // about 1 long; zero: nothing is known
    double sigma = 3.2;                              // rad, 1 sigma of the axis' direction
  };
  Line line() const;

  // Returns the gyros' constant error (rad/s), given the vertical in the unit's axes.
  Eigen::Vector3d bias(const Eigen::Vector3d& up) const {
    return (rates_ - course_rates_ * up) / weights_;
  }

 private:
  double weights_ = 0.0, course_rates_ = 0.0, course_squares_ = 0.0, rate_squares_ = 0.0;
  Eigen::Vector3d rates_ = Eigen::Vector3d::Zero(), products_ = Eigen::Vector3d::Zero();
};

}  // namespace maploop::sensors
