// Computes how fast a driver goes along a path.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulate/town/lane_path.h"

namespace maploop::simulate {

struct DriverParameters {
  double lateral_acceleration = 2.2;  // m/s^2, maximum in curves
  double acceleration = 1.5;          // m/s^2
  double braking = 2.2;               // m/s^2
  double stop_chance = 0.3;           // probability of a stop at each stop line
  double shortest_stop = 4.0;         // s
  double longest_stop = 7.0;          // s
};

// Returns a path length in m that is sufficient for a drive of `seconds` at `fastest` m/s.
double longest_drive(double seconds, double fastest = 13.9);

// Speed is a uniform cubic B-spline of time: jerk is continuous nearly everywhere, and a standing
// car has exactly zero speed. The way is its integral.
class SpeedProfile {
 public:
  // Starts 15 m into the path at the speed allowed there, and lasts `seconds` plus two. Throws
  // std::runtime_error if the path is too short.
  SpeedProfile(const LanePath& path, const Streets& streets, double seconds, std::uint64_t seed,
               const DriverParameters& parameters = {});

  double way(double t) const;           // m along the path
  double speed(double t) const;         // m/s, along `way`
  double acceleration(double t) const;  // m/s^2, along `way`

 private:
  struct Place {
    std::size_t interval;
    double share;
  };
  Place place(double t) const;

  std::vector<double> speed_;  // control points
  std::vector<double> way_;    // at the start of each interval
};

}  // namespace maploop::simulate
