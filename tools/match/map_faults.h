// What the matcher says where the map is wrong.
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "mapmatch/network_builder.h"
#include "tools/match/match_score.h"

namespace maploop::match {

// Each place off by a smooth error: so many metres rms an axis, that change within `length` metres.
mapmatch::NetworkData bent(mapmatch::NetworkData network, double metres, double length,
                           std::uint64_t seed);
mapmatch::NetworkData shifted(mapmatch::NetworkData network, const Eigen::Vector2d& metres);
// Every one-way street the other way round.
mapmatch::NetworkData one_way_reversed(mapmatch::NetworkData network);
// A made-up road so far to the right of each of these ways, which leaves it and comes back to it at
// its ends.
mapmatch::MapExtract with_parallels(const mapmatch::MapExtract& map,
                                    const std::set<std::int64_t>& ways, double metres);
mapmatch::NetworkData without_way(const mapmatch::MapExtract& map, std::int64_t way_id);

// Of one drive on a wrong map.
struct FaultScore {
  double longest_sure_wrong = 0.0;  // s without a break with a wrong link of P above 0.9
  double recovery = 0.0;  // m, the longest from where the map is right again to the right link
  // Fixes on the way that is missing, those of them with a link, with one of P above 0.9, and the
  // sum of P.
  std::size_t missing_fixes = 0, missing_said = 0, missing_sure = 0;
  double missing_p_sum = 0.0;
  double worst_at = 0.0;  // s since the track's begin where longest_sure_wrong ended
};

// `missing` is the way that the map lacks, or 0: a link said while the vehicle is there is wrong.
FaultScore score_fault(const std::vector<MatchedFix>& matched, const Track& track,
                       const std::vector<std::size_t>& rows,
                       const std::map<std::size_t, Label>& labels, std::int64_t missing);

}  // namespace maploop::match
