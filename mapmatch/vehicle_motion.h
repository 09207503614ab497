// How the vehicle moves, from fixes that may or may not say it, and how their errors behave.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "mapmatch/match_parameters.h"
#include "mapmatch/vehicle_fix.h"

namespace maploop::mapmatch {

// The motion up to a fix. Angles in rad.
struct Motion {
  double interval = 0.0;  // s since the fix before; 0 at the first
  double speed = 0.0;     // m/s
  double speed_sigma = 0.0;
  double azimuth = unknown;  // unknown while too slow to tell
  double azimuth_sigma = 0.0;
  double distance = 0.0;                           // m since the fix before
  Eigen::Vector2d step = Eigen::Vector2d::Zero();  // m, the same as a vector
  double turn = unknown;                           // |change of azimuth| over the last second
  double turn_rate = unknown;                      // rad/s, its size over the last second
  double reversal = unknown;                       // |change of azimuth| over the last 6 s
  // Of visual odometry, where it agrees with the rest.
  double visual_speed = unknown;
  double visual_turn = unknown;      // |change of azimuth| over the last second
  double visual_reversal = unknown;  // over the last 6 s
  double white_share = 0.5;          // of the fixes' variance: what changes from fix to fix
};

class VehicleMotion {
 public:
  void reset() { *this = VehicleMotion(); }

  // Fixes in the order of their stamps; `place` is the fix's in local metres. Where it does not say
  // speed or azimuth, they come from a Kalman filter of positions and velocities.
  Motion add(const VehicleFix& fix, const Eigen::Vector2d& place,
             const MatchParameters& parameters);

  template <class Archive>
  void archive(Archive& ar) {
    ar(count_, stamp_, place_, course_, course_covariance_, speed_, azimuth_, jumps_, expected_,
       history_, next_);
  }

 private:
  struct Moment {
    Time stamp{};
    double azimuth = unknown, visual_azimuth = unknown, yaw_rate = unknown;
    template <class Archive>
    void archive(Archive& ar) {
      ar(stamp, azimuth, visual_azimuth, yaw_rate);
    }
  };
  static constexpr std::size_t history_length = 128;  // 6 s at 20 Hz

  void filter_course(const VehicleFix& fix, const Eigen::Vector2d& place, double interval);
  void estimate_white_share(const VehicleFix& fix, const Eigen::Vector2d& jump, double interval);
  double change(double Moment::*angle, const Moment& now, double seconds) const;
  bool seen_throughout(const Moment& now, double seconds) const;
  void add_visual(const VehicleFix& fix, const Moment& now, const MatchParameters& parameters,
                  Motion& motion) const;
  double mean_yaw_rate(const Moment& now) const;

  std::size_t count_ = 0;
  Time stamp_{};
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  Eigen::Vector4d course_ = Eigen::Vector4d::Zero();  // position, velocity
  Eigen::Matrix4d course_covariance_ = Eigen::Matrix4d::Zero();
  double speed_ = 0.0;
  double azimuth_ = unknown;
  double jumps_ = 0.0, expected_ = 0.0;  // squares, with a prior, forgotten over a minute
  std::array<Moment, history_length> history_{};
  std::size_t next_ = 0;
};

}  // namespace maploop::mapmatch
