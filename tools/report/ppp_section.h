// Adds the results of precise point positioning.
#pragma once

#include "tools/report/report.h"
#include "tools/web/page.h"

namespace maploop::report {

// Adds nothing if there were no observations. Errors are those of the antenna against the truth.
void add_ppp(web::Page& page, const ReplayReport& report);

}  // namespace maploop::report
