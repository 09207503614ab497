// Counts how often the matched way is the one really driven.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "mapmatch/matcher.h"
#include "tools/match/labels.h"
#include "tools/match/track.h"

namespace maploop::match {

// A fix and its matched segment.
struct MatchedFix {
  std::optional<std::int64_t> way_id;  // empty: not on a road, or unknown
  std::int64_t node_a = 0, node_b = 0;
  double p_link = 0.0;
  std::optional<mapmatch::DirectedLink> link{};  // if it is known
};

struct Tally {
  std::size_t fixes = 0, matched = 0, right = 0;

  std::size_t wrong() const { return fixes - right; }
  double share() const {
    return fixes ? static_cast<double>(right) / static_cast<double>(fixes) : 0;
  }
  double coverage() const {
    return fixes ? static_cast<double>(matched) / static_cast<double>(fixes) : 0;
  }
};

// For matches with P between k/10 and (k+1)/10: how many are right. They are compared by link if
// the matched and the driven link are known, otherwise by way.
struct Reliability {
  std::array<std::size_t, 10> fixes{}, right{};
  std::array<double, 10> p_sum{};
};

struct MatchScore {
  Tally all, certain;
  Reliability reliability;

  // `rows` are the track's row numbers of the fixes; fixes without a label do not count.
  void add(const std::vector<MatchedFix>& matched, const std::vector<std::size_t>& rows,
           const std::map<std::size_t, Label>& labels);
};

MatchedFix matched_fix(const mapmatch::MatchResult& result, const mapmatch::RoadNetwork& network);

// Returns the match of each fix of a track.
std::vector<MatchedFix> match_track(mapmatch::Matcher& matcher, const Track& track);

// The baseline: returns the nearest segment within 100 m whose azimuth differs by at most 50
// degrees from the vehicle's.
std::vector<MatchedFix> nearest_segments(const mapmatch::RoadNetwork& network, const Track& track);

}  // namespace maploop::match
