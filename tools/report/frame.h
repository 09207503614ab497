// The common frame of the page's pictures, and the truth in it.
#pragma once

#include <optional>

#include "sensors/replay/reference_trajectory.h"
#include "tools/report/report.h"

namespace maploop::report {

// Returns the origin of the first state; if there is none, the first reference pose, or the first
// position by PPP.
Geodetic origin_of(const ReplayReport& report);

// Returns nothing if the recording has no reference.
std::optional<sensors::ReferenceTrajectory> truth_of(const ReplayReport& report);

// Returns the time from which plots count their seconds.
Time first_of(const ReplayReport& report);

}  // namespace maploop::report
