// The line along which a car drives a route.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulate/town/streets.h"

namespace maploop::simulate {

// A uniform cubic B-spline in the plane: position, direction and curvature are continuous. Its
// parameter `way` equals metres to a few percent; |derivative| gives the exact ratio. Outside [0,
// length] the curve stays at its ends.
class LanePath {
 public:
  // One street of the route, as an interval of `way`.
  struct Stretch {
    DirectedStreet street;
    double begin = 0.0, end = 0.0;  // between the centres of the junctions
    double stop_line = 0.0;         // `way` before the junction at its end
  };

  // The path keeps to the right lane, rounds junctions in curves, wanders a little in the lane, and
  // now and then shifts to the lane's left side and back, as if to pass a stopped vehicle.
  LanePath(const Streets& streets, const std::vector<DirectedStreet>& route, std::uint64_t seed);

  double length() const { return static_cast<double>(points_.size()) - 3.0; }
  const std::vector<Stretch>& stretches() const { return stretches_; }

  Eigen::Vector2d position(double way) const { return evaluate(way, 0); }
  Eigen::Vector2d derivative(double way) const { return evaluate(way, 1); }
  double curvature(double way) const;  // 1/m, positive to the left

 private:
  Eigen::Vector2d evaluate(double way, int order) const;

  std::vector<Eigen::Vector2d> points_;  // control points, 1 m apart
  std::vector<Stretch> stretches_;
};

}  // namespace maploop::simulate
