#include "tools/match/driven_links.h"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace maploop::match {
namespace {

constexpr Duration near = std::chrono::milliseconds(60);  // half a frame period, with margin

}  // namespace

TimedMatch timed_match(const MapMatch& match) {
  if (!match.on_road) return {match.stamp, {}};
  return {match.stamp, {match.way_id, match.node_a, match.node_b, match.probability, match.link}};
}

std::optional<std::size_t> frame_at(Time t, const std::vector<Time>& stamps) {
  if (stamps.empty()) return std::nullopt;
  auto at = std::lower_bound(stamps.begin(), stamps.end(), t);
  if (at == stamps.end() || (at != stamps.begin() && t - *std::prev(at) < *at - t)) --at;
  if (std::chrono::abs(*at - t) > near) return std::nullopt;
  return static_cast<std::size_t>(at - stamps.begin());
}

MatchScore score_matches(const std::vector<TimedMatch>& matches, const std::vector<Time>& stamps,
                         const std::map<std::size_t, Label>& labels) {
  std::vector<MatchedFix> matched;
  std::vector<std::size_t> rows;
  for (const TimedMatch& match : matches) {
    const auto frame = frame_at(match.stamp, stamps);
    if (!frame) continue;
    matched.push_back(match.matched);
    rows.push_back(*frame);
  }
  MatchScore score;
  score.add(matched, rows, labels);
  return score;
}

}  // namespace maploop::match
