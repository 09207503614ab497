// Reads matches from a file, for scoring.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/match/driven_links.h"

namespace maploop::match {

// Reads the CSV file of `maploop match --csv` (files of other matchers need the columns t and
// way_id, and may have p_link, node_a, node_b) or the MAP_MATCH messages of an LCM log; plain or
// .gz. Returns them in the order of the file. Throws std::runtime_error naming file and line.
std::vector<TimedMatch> read_matches(const std::filesystem::path& file);

}  // namespace maploop::match
