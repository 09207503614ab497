// Stores the path of the vehicle for browsers that connect later.
#pragma once

#include <deque>
#include <string>

#include "msgs/nav_state.h"
#include "msgs/reference.h"

namespace maploop::dashboard {

// It stores five points a second of the newest twenty minutes. A point removes all points with
// later stamps, because a replay may seek back. A new origin clears it. An object belongs to one
// thread.
class Trail {
 public:
  void add(const NavState& state);
  void add(const ReferencePose& truth);  // ignored before the first state

  // Returns {"origin": [latitude, longitude, height (rad, m)], "fused": [[s, east, north, up],
  // ...], "truth": ...}.
  std::string json() const;

 private:
  struct Point {
    Time stamp;
    Eigen::Vector3d enu;  // m
  };
  static void append(std::deque<Point>& points, const Point& point);

  bool started_ = false;
  Geodetic origin_;
  LocalFrame frame_;
  std::deque<Point> fused_, truth_;
};

}  // namespace maploop::dashboard
