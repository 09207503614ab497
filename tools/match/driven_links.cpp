#include "tools/match/driven_links.h"

#include <chrono>
#include <iterator>

namespace maploop::match {
namespace {

constexpr Duration nearest = std::chrono::milliseconds(60);

}  // namespace

MatchedFix matched_fix(const MapMatch& match) {
  if (!match.on_road) return {};
  return {match.way_id, match.node_a, match.node_b, match.probability};
}

MatchScore score_matches(const MatchesByTime& matches, const std::vector<Time>& stamps,
                         const std::map<std::size_t, Label>& labels) {
  MatchScore score;
  if (matches.empty()) return score;
  const Time first = matches.begin()->first - nearest;
  const Time last = matches.rbegin()->first + nearest;
  std::vector<MatchedFix> matched;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < stamps.size(); ++row) {
    const Time t = stamps[row];
    if (t < first || t > last) continue;
    auto at = matches.lower_bound(t);
    if (at == matches.end() || (at != matches.begin() && t - std::prev(at)->first < at->first - t))
      --at;
    const bool near = std::chrono::abs(at->first - t) <= nearest;
    matched.push_back(near ? at->second : MatchedFix{});
    rows.push_back(row);
  }
  score.add(matched, rows, labels);
  return score;
}

}  // namespace maploop::match
