// The parts of a profile's page, for pages that show more.
#pragma once

#include "tools/profile/profile.h"
#include "tools/web/page.h"

namespace maploop::profile {

// Table of threads and paths, worst misses, distributions.
void add_latencies(web::Page& page, const Profile& profile);

void add_processor_time(web::Page& page, const Profile& profile);

}  // namespace maploop::profile
