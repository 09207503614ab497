// How fast a driver goes along a path.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulate/lane_path.h"

namespace maploop::simulate {

struct DriverParameters {
  double lateral_acceleration = 2.2;  // m/s^2, at most in curves
  double acceleration = 1.5;          // m/s^2
  double braking = 2.2;               // m/s^2
  double stop_chance = 0.3;           // of a junction, at its stop line
  double shortest_stop = 4.0;         // s
  double longest_stop = 7.0;          // s
};

// m, at least what a drive of so many seconds needs of a path, at m/s.
double longest_drive(double seconds, double fastest = 13.9);

// Speed is a uniform cubic B-spline of time: jerk is continuous nearly everywhere, and a standing
// car stands exactly. Way is its integral.
class SpeedProfile {
 public:
  // From 15 m into the path, at the speed that is right there, for `seconds` and two more. Throws
  // std::runtime_error where the path is too short.
  SpeedProfile(const LanePath& path, const Streets& streets, double seconds, std::uint64_t seed,
               const DriverParameters& parameters = {});

  double way(double t) const;           // m along the path
  double speed(double t) const;         // m/s of way
  double acceleration(double t) const;  // m/s^2 of way

 private:
  struct Place {
    std::size_t interval;
    double share;
  };
  Place place(double t) const;

  std::vector<double> speed_;  // control points
  std::vector<double> way_;    // at the begin of each interval
};

}  // namespace maploop::simulate
