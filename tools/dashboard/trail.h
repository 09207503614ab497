// Where the vehicle has been, for browsers that come later.
#pragma once

#include <deque>
#include <string>

#include "msgs/nav_state.h"
#include "msgs/reference.h"

namespace maploop::dashboard {

// Some points a second, the newest twenty minutes. What lies after the newest stamp is forgotten: a
// replay may go back. A new origin starts it again. One thread's own.
class Trail {
 public:
  void add(const NavState& state);
  void add(const ReferencePose& truth);  // kept once there is a state

  // {"origin": [latitude, longitude, height (rad, m)], "fused": [[s, east, north], ...], "truth":
  // ...}
  std::string json() const;

 private:
  struct Point {
    Time stamp;
    double east, north;  // m
  };
  static void append(std::deque<Point>& points, const Point& point);

  bool started_ = false;
  Geodetic origin_;
  LocalFrame frame_;
  std::deque<Point> fused_, truth_;
};

}  // namespace maploop::dashboard
