// The frame that everything on the page is drawn in, and the truth in it.
#pragma once

#include <optional>

#include "sensors/replay/reference_trajectory.h"
#include "tools/report/report.h"

namespace maploop::report {

// Of the first state; else of the first reference pose, or of the first position by PPP.
Geodetic origin_of(const ReplayReport& report);

// Nothing where the recording has no reference.
std::optional<sensors::ReferenceTrajectory> truth_of(const ReplayReport& report);

// The moment that plots count their seconds from.
Time first_of(const ReplayReport& report);

}  // namespace maploop::report
