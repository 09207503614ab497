// Matches that were written to a file, for scoring.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/match/driven_links.h"

namespace maploop::match {

// What `maploop match --csv` writes (of another matcher: the columns t, way_id, and p_link, node_a,
// node_b where it has them), or MAP_MATCH of an LCM log; plain or .gz. In the order of the file.
// Throws std::runtime_error naming file and line.
std::vector<TimedMatch> read_matches(const std::filesystem::path& file);

}  // namespace maploop::match
