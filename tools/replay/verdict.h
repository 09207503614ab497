// The end of a run in three lines, and why it came to nothing where it did.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "tools/replay/replay_result.h"

namespace maploop::tools {

// Where the run ended; how good its positions are, and against what; what the configuration did not
// use, and why. Lines without their ends, each of at most 79 columns.
std::array<std::string, 3> verdict(const ReplayResult& result);

// The same as one text, each line with its end.
std::string verdict_text(const ReplayResult& result);

// The reason and the remedy where the run has no result: no position, or none on a road of its map.
// Nothing where it has one, where it was interrupted, and for a live run to which a sensor spoke. A
// capture of a LiDAR alone has its odometry for a result.
std::optional<std::string> why_empty(const ReplayResult& result);

}  // namespace maploop::tools
