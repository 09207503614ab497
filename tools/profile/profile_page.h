// The parts of a profile's page, for use in other pages.
#pragma once

#include "tools/profile/profile.h"
#include "tools/web/page.h"

namespace maploop::profile {

// Adds the table of threads and paths, the worst misses, and the distributions.
void add_latencies(web::Page& page, const Profile& profile);

void add_processor_time(web::Page& page, const Profile& profile);

}  // namespace maploop::profile
