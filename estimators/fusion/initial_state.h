// The first state of the filter comes from one moving GNSS fix or from known values.
#pragma once

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/gnss.h"

namespace maploop::fusion {

// Holds values of the vehicle from another source, such as a surveyed place or the end of the last
// drive.
struct KnownStart {
  Time stamp{};                                                     // of all values
  Geodetic position;                                                // of the body's origin
  Attitude attitude;                                                // of the body
  double speed = 0.0;                                               // m/s, negative in reverse
  Eigen::Vector3d position_sigma = Eigen::Vector3d::Constant(0.1);  // m, east, north, up
  double azimuth_sigma = 0.0017;                                    // rad (0.1 deg)
  double tilt_sigma = 0.0087;                                       // rad (0.5 deg), pitch and roll
  double speed_sigma = 0.05;                                        // m/s
  // If the position comes from fixes: the lasting part of their error (o of METHOD.md), and how it
  // correlates with the position of the same axis, from -1 to 1.
  Eigen::Vector3d fix_offset = Eigen::Vector3d::Zero();              // o, east, north, up
  Eigen::Vector3d fix_offset_sigma = Eigen::Vector3d::Ones();        // of o; 1: o is not known
  Eigen::Vector3d fix_offset_correlation = Eigen::Vector3d::Zero();  // -1 to 1
};

// Returns Reason::none, out_of_range or not_finite.
Reason check_start(const KnownStart& known);
// Returns the state at known.stamp, with errors of sensors as the parameters give them. Does not
// check the values (check_start).
FilterState initial_state(const KnownStart& known, const LocalFrame& frame,
                          const FusionParameters& parameters);

// Returns the earlier of the fix's two stamps, which is where the filter starts.
Time start_stamp(const GnssFix& fix);

// Returns whether the fix is fast enough to show a course.
bool moves(const GnssFix& fix, const FusionParameters& parameters);

// Returns Reason::none, or the reason why the fix cannot start a filter.
Reason check_fix(const GnssFix& fix, const FusionParameters& parameters);

// Returns whether a fix whose velocity is too uncertain to start a filter at once shows a course to
// `late_course_sigma`.
bool shows_late_course(const GnssFix& fix, const FusionParameters& parameters);

// Returns the state at start_stamp(fix). The velocity moves the position to this time. Speed,
// azimuth and pitch are the velocity's length, course and climb (the vehicle is assumed to drive
// forward). The antenna swings about the rear axle at `yaw_rate` (rad/s, to the left), which is
// taken off. The fix's covariance is propagated through this. Precondition: check_fix returns
// Reason::none, or shows_late_course() is true.
FilterState initial_state(const GnssFix& fix, const LocalFrame& frame,
                          const FusionParameters& parameters, double yaw_rate = 0.0);

}  // namespace maploop::fusion
