// Visual odometry provides the vehicle's speed, and an azimuth of which only changes matter.
#pragma once

#include "mapmatch/vehicle_fix.h"
#include "msgs/odometry.h"

namespace maploop::mapmatch {

// Not thread-safe; allocates nothing.
class VisualCourse {
 public:
  // Takes motions in the order of their stamps. After a motion without a pose, or one that does not
  // begin where the previous one ended, the azimuth restarts.
  void add(const RelativeMotion& motion);

  // Fills in the fix's visual_speed and visual_azimuth, extrapolated to its stamp. They are unknown
  // if the last motion is more than 0.3 s away. The azimuth is also unknown once after it
  // restarted, so that no change is measured across the break.
  void describe(VehicleFix& fix);

  template <class Archive>
  void archive(Archive& ar) {
    ar(stamp_, known_, begun_anew_, speed_, azimuth_, rate_);
  }

 private:
  Time stamp_{};
  bool known_ = false, begun_anew_ = true;
  double speed_ = 0.0;    // m/s, forward
  double azimuth_ = 0.0;  // rad, from an arbitrary direction
  double rate_ = 0.0;     // rad/s, its rate
};

}  // namespace maploop::mapmatch
