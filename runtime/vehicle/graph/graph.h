// The declaration of the vehicle's graph, from which it is built, watched and documented.
#pragma once

#include <string>

#include "runtime/vehicle/graph/channel_specs.h"
#include "runtime/vehicle/graph/ring_specs.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

// The declaration as the Markdown page GRAPH.md.
std::string graph_page();

}  // namespace maploop::vehicle
