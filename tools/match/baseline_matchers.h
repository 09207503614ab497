// Matchers of the literature, to compare with on the same fixes. Each returns one match a fix.
#pragma once

#include <vector>

#include "tools/match/match_score.h"

namespace maploop::match {

// Returns the nearest segment within 100 m whose azimuth differs by at most 50 degrees from the
// vehicle's.
std::vector<MatchedFix> nearest_segments(const mapmatch::RoadNetwork& network, const Track& track);

// Returns the link with the greatest weight after Greenfeld ("Matching GPS observations to
// locations on a digital map", 2002): of its azimuth against that of the line between two fixes, of
// the distance from it, and of the crossing of this line, among the links that meet the last one;
// among all near ones at first and where none of these is within 100 m. It uses positions alone.
std::vector<MatchedFix> topological_weights(const mapmatch::RoadNetwork& network,
                                            const Track& track);

// Returns the nearest link in the 99 % error ellipse of the fix, of those whose azimuth differs by
// at most 50 degrees, and of these those that meet the last link, if any does (after Ochieng,
// Quddus and Noland, "Map-matching in complex urban road networks", 2003). Matches nothing if no
// link is in the ellipse.
std::vector<MatchedFix> probabilistic_ellipse(const mapmatch::RoadNetwork& network,
                                              const Track& track);

// Returns the likeliest path of the hidden Markov model of Newson and Krumm ("Hidden Markov map
// matching through noise and sparseness", 2009), by all fixes of the track. It uses positions
// alone, one a second; other fixes are on the nearer of the links before and after them. `beta` (m)
// is the mean difference between the driven distance and the straight line.
std::vector<MatchedFix> hidden_markov(const mapmatch::RoadNetwork& network, const Track& track,
                                      double beta);

}  // namespace maploop::match
