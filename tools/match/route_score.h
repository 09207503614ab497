// Compares the route of a matched track with the links really driven, by length.
#pragma once

#include <vector>

#include "tools/match/driven_route.h"
#include "tools/match/match_score.h"

namespace maploop::match {

// The two shares are those of Newson and Krumm ("Hidden Markov map matching through noise and
// sparseness", ACM GIS 2009), which Valhalla publishes, too: their sum, missing and too much, is
// the route mismatch fraction.
struct RouteScore {
  double driven = 0.0;    // m, without the first and the last link
  double right = 0.0;     // m of these that the route has in the same order
  double too_much = 0.0;  // m of the route that were not driven

  RouteScore& operator+=(const RouteScore& more) {
    driven += more.driven;
    right += more.right;
    too_much += more.too_much;
    return *this;
  }
  double right_share() const { return driven > 0.0 ? right / driven : 0.0; }
  double too_much_share() const { return driven > 0.0 ? too_much / driven : 0.0; }
};

// `rows` are the row numbers of the track's fixes in `labels`, which must have been looked up in
// the network. Fixes before the first label and after the last one do not count.
RouteScore score_route(const MatchedTrack& track, const std::vector<std::size_t>& rows,
                       const Labels& labels, const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
