// The first state, from one moving GNSS fix.
#pragma once

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/outcome.h"
#include "msgs/gnss.h"

namespace maploop::fusion {

// What somebody else knows of the vehicle: a surveyed place, the end of the last drive.
struct KnownStart {
  Time stamp{};
  Geodetic position;
  Attitude attitude;
  double speed = 0.0;             // m/s, negative in reverse
  double position_sigma = 0.1;    // m an axis
  double azimuth_sigma = 0.0017;  // rad (0.1 deg)
  double tilt_sigma = 0.0087;     // rad (0.5 deg), pitch and roll
  double speed_sigma = 0.05;      // m/s
};

// Reason::none, or out_of_range, not_finite.
Reason check_start(const KnownStart& known);
FilterState initial_state(const KnownStart& known, const LocalFrame& frame,
                          const FusionParameters& parameters);

// The earlier of the fix's two stamps: where the filter starts.
Time start_stamp(const GnssFix& fix);

// Reason::none, or why the fix cannot start a filter.
Reason check_fix(const GnssFix& fix, const FusionParameters& parameters);

// State at start_stamp(fix): the position is carried there by the velocity; speed, azimuth and
// pitch are the velocity's length, course and climb (the vehicle is taken to drive forward), with
// the fix's covariance carried through. Precondition: check_fix says none.
FilterState initial_state(const GnssFix& fix, const LocalFrame& frame,
                          const FusionParameters& parameters);

}  // namespace maploop::fusion
