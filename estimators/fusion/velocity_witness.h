// The velocities of fixes judge the other aids. They do so without the state, because a wrong aid
// may have made the state what it is.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "msgs/gnss.h"
#include "msgs/local_frame.h"

namespace maploop::fusion {

struct FilterState;

// Judges before the velocity corrects the state, also where it will be refused:
//
// Wheels that contradict the fixes for seconds are not used any more (WheelCheck), and their share
// in the state is doubted.
//
// On a ferry, inertial unit and wheels show a standing vehicle. Where fixes say for seconds that it
// moves, it does not stand.
//
// A start from a course assumes that the vehicle drives forward. If it was in reverse, it later
// races backwards, or, where odometry or wheels tell the sign of the speed, the fixes go where its
// rear is. Then the front is where the rear was assumed. Once the vehicle has been faster than any
// reverses, its front is known.
//
// A velocity that is uncertain, or that the fused motion has made (increment), does not judge.
void judge_by_velocity(FilterState& state, const GnssFix& fix, const LocalFrame& frame,
                       const FusionParameters& parameters);

}  // namespace maploop::fusion
