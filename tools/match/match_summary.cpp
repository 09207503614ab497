#include "tools/match/match_summary.h"

namespace maploop::match {

double MatchSummary::doubtful_share() const {
  return matched ? static_cast<double>(doubtful) / static_cast<double>(matched) : 0.0;
}

MatchSummary summary(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  MatchSummary s;
  s.fixes = track.fixes.size();
  for (const std::size_t i : track.used()) {
    const mapmatch::MatchResult& r = track.results[i];
    if (!r.on_road) continue;
    ++s.matched;
    s.doubtful += r.probability < sure;
  }
  s.unused = unused_fixes(track, network);
  s.off_road = s.fixes - s.matched;
  for (const auto& [reason, count] : s.unused) s.off_road -= count;
  return s;
}

}  // namespace maploop::match
