// Compares matches with the links really driven.
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

// Returns the index of the frame nearest to a time, or nothing if there is none within 60 ms.
// `stamps` increase.
std::optional<std::size_t> frame_at(Time t, const std::vector<Time>& stamps);

// Scores each match against the label of the frame nearest to it; matches without such a frame do
// not count.
MatchScore score_matches(const std::vector<TimedMatch>& matches, const std::vector<Time>& stamps,
                         const std::map<std::size_t, Label>& labels);

}  // namespace maploop::match
