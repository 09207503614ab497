// Which road the vehicle was on, and how often that was right.
#pragma once

#include "tools/report/report.h"
#include "tools/web/page.h"

namespace maploop::report {

// Nothing where no map was matched. How much was right is there where the recording says which
// links were driven.
void add_roads(web::Page& page, const ReplayReport& report);

}  // namespace maploop::report
