// Finds the one-way streets that would leave fewer junctions without an exit or without an entry if
// they ran the other way.
#pragma once

#include <cstdint>
#include <vector>

namespace maploop::mapmatch {

class RoadNetwork;

// Returns the one-way links of these ways; a link may occur twice. At each junction that traffic
// cannot leave or cannot reach, it is the way whose reversal opens the most of them.
std::vector<std::uint32_t> dead_ended_links(const RoadNetwork& network);

}  // namespace maploop::mapmatch
