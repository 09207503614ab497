// What visual odometry says of a vehicle's course: its speed, and an azimuth whose changes count.
#pragma once

#include "mapmatch/vehicle_fix.h"
#include "msgs/odometry.h"

namespace maploop::mapmatch {

// Not thread-safe; allocates nothing.
class VisualCourse {
 public:
  // Motions in the order of their stamps. After one without a pose, or that does not begin where
  // the one before ended, the azimuth is a new one.
  void add(const RelativeMotion& motion);

  // Fills in the fix's visual_speed and visual_azimuth, carried on to its stamp. They stay unknown
  // where the last motion is older than 0.3 s; and once after the azimuth began anew, so that no
  // change is taken across the break.
  void describe(VehicleFix& fix);

  template <class Archive>
  void archive(Archive& ar) {
    ar(stamp_, known_, begun_anew_, speed_, azimuth_, rate_);
  }

 private:
  Time stamp_{};
  bool known_ = false, begun_anew_ = true;
  double speed_ = 0.0;    // m/s, forward
  double azimuth_ = 0.0;  // rad, from any direction
  double rate_ = 0.0;     // rad/s, of it
};

}  // namespace maploop::mapmatch
