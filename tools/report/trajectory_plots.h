// Where the vehicle went, and how far off the fused state was.
#pragma once

#include <vector>

#include "tools/report/report.h"
#include "tools/web/plot.h"

namespace maploop::report {

// Seen from above, in the fused state's own frame, over the roads of the replay's map: truth,
// fused, PPP, matched points, and dead reckoning laid onto the truth's first pose (the fused one
// without a truth).
web::Plot trajectory_map(const ReplayReport& report);

// Against seconds of the drive: errors with three standard deviations that the filter claims, and
// the speed. Without a truth only what the filter claims.
std::vector<web::Plot> state_plots(const ReplayReport& report);

}  // namespace maploop::report
