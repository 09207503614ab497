#include "tools/match/route_score.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace maploop::match {
namespace {

using mapmatch::DirectedLink;

// A part of a way, in the order of the drive.
struct Part {
  DirectedLink link;
  double length = 0.0;  // m
};

// Returns the links really driven, also those between two labels.
std::vector<Part> driven_links(const Labels& labels, const mapmatch::RoadNetwork& network) {
  constexpr double most_between = 200.0;  // m
  std::vector<Part> parts;
  const auto drive = [&](DirectedLink link) {
    parts.push_back({link, network.link(link.link).length});
  };
  std::optional<DirectedLink> before;
  for (const auto& [row, label] : labels) {
    if (!label.link || label.link == before) continue;
    if (before) {
      const auto between = links_between(network, *before, *label.link, most_between);
      if (between) std::for_each(between->begin(), between->end(), drive);
    }
    drive(*label.link);
    before = label.link;
  }
  return parts;
}

std::vector<Part> parts_of(const DrivenRoute& route) {
  std::vector<Part> parts;
  for (const DrivenRoute::Piece& piece : route.pieces)
    for (const RouteStep& step : piece) parts.push_back({step.link, step.length()});
  return parts;
}

// Returns the length of the longest sequence of links that both have in the same order.
double common_length(const std::vector<Part>& a, const std::vector<Part>& b) {
  std::vector<double> above(b.size() + 1, 0.0), row(b.size() + 1, 0.0);
  for (const Part& part : a) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      row[k + 1] = std::max(row[k], above[k + 1]);
      if (part.link == b[k].link)
        row[k + 1] = std::max(row[k + 1], above[k] + std::min(part.length, b[k].length));
    }
    std::swap(above, row);
  }
  return above.back();
}

double length_of(const std::vector<Part>& parts) {
  double length = 0.0;
  for (const Part& part : parts) length += part.length;
  return length;
}

MatchedTrack labelled_part(const MatchedTrack& track, const std::vector<std::size_t>& rows,
                           const Labels& labels) {
  MatchedTrack part;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] < labels.begin()->first || rows[i] > labels.rbegin()->first) continue;
    part.fixes.push_back(track.fixes[i]);
    part.results.push_back(track.results[i]);
  }
  return part;
}

// Removes the first and the last link, as it is not known how far they were driven. A match may be
// a link ahead of the drive, or behind it.
void leave_out(std::vector<Part>& parts, DirectedLink first, DirectedLink last) {
  const auto two = static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, parts.size()));
  const auto is = [](DirectedLink link) {
    return [link](const Part& part) { return part.link == link; };
  };
  const auto end = std::find_if(parts.end() - two, parts.end(), is(last));
  if (end != parts.end()) parts.erase(end);
  const auto start_two = parts.begin() + std::min<std::ptrdiff_t>(two, std::ssize(parts));
  const auto start = std::find_if(parts.begin(), start_two, is(first));
  if (start != start_two) parts.erase(start);
}

}  // namespace

RouteScore score_route(const MatchedTrack& track, const std::vector<std::size_t>& rows,
                       const Labels& labels, const mapmatch::RoadNetwork& network) {
  std::vector<Part> driven = driven_links(labels, network);
  if (driven.size() < 3) return {};
  std::vector<Part> found = parts_of(driven_route(labelled_part(track, rows, labels), network));
  const DirectedLink first = driven.front().link, last = driven.back().link;
  leave_out(driven, first, last);
  leave_out(found, first, last);
  RouteScore score;
  score.driven = length_of(driven);
  score.right = common_length(driven, found);
  score.too_much = length_of(found) - score.right;
  return score;
}

}  // namespace maploop::match
