// Adds the roads that the vehicle was matched to, and how often they were right.
#pragma once

#include "tools/report/report.h"
#include "tools/web/page.h"

namespace maploop::report {

// Adds nothing if no map was matched. The share that was right is added if the recording contains
// the links driven.
void add_roads(web::Page& page, const ReplayReport& report);

}  // namespace maploop::report
