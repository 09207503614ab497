// Matches of a run against the links really driven.
#pragma once

#include <map>
#include <vector>

#include "msgs/map_match.h"
#include "msgs/time.h"
#include "tools/match/match_score.h"

namespace maploop::match {

using MatchesByTime = std::map<Time, MatchedFix>;

MatchedFix matched_fix(const MapMatch& match);

// `stamps` are the labels' frames. Each frame counts by the match nearest to it in time (none
// within 60 ms: not matched); those before the first or after the last match do not count.
MatchScore score_matches(const MatchesByTime& matches, const std::vector<Time>& stamps,
                         const std::map<std::size_t, Label>& labels);

}  // namespace maploop::match
