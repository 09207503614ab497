// The line that a car drives along a route.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulate/streets.h"

namespace maploop::simulate {

// A uniform cubic B-spline through the plane: position, direction and curvature are continuous. The
// way u is in metres to a few percent; |derivative| says how nearly. Outside [0, length] it stays
// at its ends.
class LanePath {
 public:
  // A part of the route on the way.
  struct Stretch {
    DirectedStreet street;
    double begin = 0.0, end = 0.0;  // way, between the middles of the junctions
    double stop_line = 0.0;         // way, before the junction at its end
  };

  // In the right lane, round the junctions in curves, wandering in the lane a little, and shifting
  // to its left side and back now and then, as around someone who stopped there.
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
