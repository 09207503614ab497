// The motion of the vehicle, and the behaviour of the fixes' errors, are estimated here from fixes
// that may or may not contain speed and azimuth.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "mapmatch/match_parameters.h"
#include "mapmatch/vehicle_fix.h"

namespace maploop::mapmatch {

// Describes the motion up to a fix. Angles are in rad.
struct Motion {
  double interval = 0.0;                           // s since the previous fix; 0 at the first
  double speed = 0.0;                              // m/s
  double speed_sigma = 0.0;                        // m/s
  double azimuth = unknown;                        // unknown at low speed
  double azimuth_sigma = 0.0;                      // 0 if the azimuth is unknown
  double distance = 0.0;                           // m since the previous fix
  Eigen::Vector2d step = Eigen::Vector2d::Zero();  // m, the same as a vector
  double turn = unknown;                           // |change of azimuth| over the last second
  double turn_rate = unknown;                      // rad/s, magnitude over the last second
  double reversal = unknown;                       // |change of azimuth| over the last 6 s
  // These come from visual odometry if it agrees with the fixes.
  double visual_speed = unknown;     // m/s
  double visual_turn = unknown;      // |change of azimuth| over the last second
  double visual_reversal = unknown;  // over the last 6 s
  double white_share = 0.5;          // share of the fixes' variance that changes between fixes
};

// A VehicleMotion remembers the fixes of the last seconds. It is not thread-safe.
class VehicleMotion {
 public:
  // Forgets all fixes: the next one counts as the first.
  void reset() { *this = VehicleMotion(); }

  // Takes fixes in the order of their stamps; `place` is the fix in local metres. Speed or azimuth
  // missing in the fix come from a Kalman filter of positions and velocities.
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
  double jumps_ = 0.0, expected_ = 0.0;  // m^2, with a prior; decays over a minute
  std::array<Moment, history_length> history_{};
  std::size_t next_ = 0;
};

}  // namespace maploop::mapmatch
