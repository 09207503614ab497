// Plots the path of the vehicle and the errors of the fused state.
#pragma once

#include <vector>

#include "tools/report/report.h"
#include "tools/web/plot.h"

namespace maploop::report {

// Plots the view from above, in the fused state's own frame, over the roads of the replay's map:
// truth, fused, PPP, matched points, and dead reckoning placed at the truth's first pose (the fused
// one without a truth).
web::Plot trajectory_map(const ReplayReport& report);

// Plots against seconds of the drive: errors with three of the filter's standard deviations, and
// the speed. Without a truth only the standard deviations and the fused speed.
std::vector<web::Plot> state_plots(const ReplayReport& report);

}  // namespace maploop::report
