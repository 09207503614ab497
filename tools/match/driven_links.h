// Matches at their moments against the links really driven.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "msgs/map_match.h"
#include "msgs/time.h"
#include "tools/match/match_score.h"

namespace maploop::match {

struct TimedMatch {
  Time stamp{};
  MatchedFix matched;
};

TimedMatch timed_match(const MapMatch& match);

// The frame nearest to a moment, where there is one within 60 ms. `stamps` increase.
std::optional<std::size_t> frame_at(Time t, const std::vector<Time>& stamps);

// Each match counts at the labels' frame nearest to it, where there is one.
MatchScore score_matches(const std::vector<TimedMatch>& matches, const std::vector<Time>& stamps,
                         const std::map<std::size_t, Label>& labels);

}  // namespace maploop::match
