// Measures how the matcher behaves if the map is wrong.
#pragma once

#include <cstdint>
#include <set>

#include "mapmatch/network_builder.h"
#include "msgs/named_enum.h"
#include "tools/match/recorded_drives.h"

namespace maploop::match {

// Returns the ways that were driven.
std::set<std::int64_t> driven_ways(const Labels& labels);

mapmatch::NetworkData shifted(mapmatch::NetworkData network, const Eigen::Vector2d& metres);
// Turns every vertex about `centre` (m), clockwise by `angle` (rad).
mapmatch::NetworkData turned(mapmatch::NetworkData network, const Eigen::Vector2d& centre,
                             double angle);
// Reverses every one-way street.
mapmatch::NetworkData one_way_reversed(mapmatch::NetworkData network);
// Makes the driven way a one-way street against the direction in which it was driven. A way that
// was driven in both directions, or is one without its nodes' labels, stays as it is.
mapmatch::MapExtract direction_wrong(const mapmatch::MapExtract& map, const Labels& labels,
                                     std::int64_t way_id);
// Makes every way that was driven in one direction the right carriageway of a road whose other
// carriageway, an invented one, is `metres` to its left.
mapmatch::MapExtract with_opposite_carriageways(const mapmatch::MapExtract& map,
                                                const Labels& labels, double metres);
// Adds an invented road `metres` to the right of each of these ways; it branches off at one end of
// the way and rejoins it at the other.
mapmatch::MapExtract with_parallels(const mapmatch::MapExtract& map,
                                    const std::set<std::int64_t>& ways, double metres);
mapmatch::NetworkData without_way(const mapmatch::MapExtract& map, std::int64_t way_id);

// A MapFault is what --map-fault of `maploop replay` and `maploop ppp` makes wrong in a map.
enum class MapFault : std::uint8_t {
  missing,     // the way driven longest
  shifted_5,   // everything by 5 m to the east
  shifted_10,  // the same by 10 m
  reversed,    // one-way streets
  parallel,    // a second road 12 m to the right of each way driven
};
constexpr auto names_of(MapFault) {
  return names_up_to<MapFault::parallel>(
      {"missing", "shifted-5-m", "shifted-10-m", "reversed", "parallel-12-m"});
}
// Throws std::runtime_error if a fault of driven ways has no labels of them.
mapmatch::NetworkData with_fault(const mapmatch::MapExtract& map, const Labels& labels,
                                 MapFault fault);

// The score of one drive on a wrong map.
struct FaultScore {
  double longest_sure_wrong = 0.0;  // s, longest uninterrupted wrong link of P above 0.9
  double recovery = 0.0;  // m, longest distance without the right way where the map has it
  // Fixes on the missing way, those of them with a link, those with a link of P above 0.9, and the
  // sum of P.
  std::size_t missing_fixes = 0, missing_said = 0, missing_sure = 0;
  double missing_p_sum = 0.0;
  double worst_at = 0.0;  // s since the track's start, when longest_sure_wrong ended
};

// States how well the doubts of one drive describe a wrong map.
struct DoubtScore {
  bool found = false;      // the wrong way is doubted for what is wrong with it
  std::size_t others = 0;  // doubts of anything else
};

// Scores the doubts that are likelier than not. `way` is what is wrong (0: nothing): it is missing,
// and then half of the doubt's fixes must be on it, or else its direction is wrong.
DoubtScore score_doubts(const std::vector<MapDoubt>& doubts, const NoisyTrack& track,
                        const Labels& labels, std::int64_t way, bool is_missing);

// `missing` is the way that the map lacks, or 0; every link matched while the vehicle is on it is
// wrong.
FaultScore score_fault(const std::vector<MatchedFix>& matched, const NoisyTrack& track,
                       const Labels& labels, std::int64_t missing);

}  // namespace maploop::match
