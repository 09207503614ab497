// Finds the route of a matched track: every link that was driven, also those between two fixes.
#pragma once

#include <optional>
#include <vector>

#include "tools/match/match_output.h"

namespace maploop::match {

// The drive along one link.
struct RouteStep {
  mapmatch::DirectedLink link;
  double from = 0.0, to = 0.0;  // m along the link
  Time entered{}, left{};       // between two fixes by the distance
  double probability = 0.0;     // mean P(link) of its fixes; that of the one before if it has none
  std::size_t fixes = 0;

  double length() const { return to - from; }
};

// The place of a fix on the route.
struct RoutePlace {
  std::size_t piece = 0;
  double distance = 0.0;  // m from the start of the piece
};

struct DrivenRoute {
  using Piece = std::vector<RouteStep>;  // from link to link
  std::vector<Piece> pieces;
  std::vector<std::optional<RoutePlace>> places;  // one for each fix; none if it is on no road
};

// Returns the links between two links that meet along at most so many metres, the legal way if
// there is one; nothing if there is no way.
std::optional<std::vector<mapmatch::DirectedLink>> links_between(
    const mapmatch::RoadNetwork& network, mapmatch::DirectedLink from, mapmatch::DirectedLink to,
    double reach);

// Two fixes are joined by the shortest way along the map, which is legal if such a way exists. A
// new piece begins where there is none that the vehicle can have driven in the time, and after a
// gap of the track's `max_gap`.
DrivenRoute driven_route(const MatchedTrack& track, const mapmatch::RoadNetwork& network);

// Writes the route as the answer of OSRM's match service (project-osrm.org, API version 5):
// `matchings` with `geometry` as GeoJSON and a leg for each two fixes, and `tracepoints`. Each
// matching also has `ways`: every link with its OpenStreetMap way, metres and times. Throws
// std::runtime_error naming the file.
void write_route(const std::filesystem::path& file, const MatchedTrack& track,
                 const mapmatch::RoadNetwork& network);
// Writes each link of the route as a line, with the members of `ways`.
void write_route_geojson(const std::filesystem::path& file, const MatchedTrack& track,
                         const mapmatch::RoadNetwork& network);
// Writes the route as a track with a segment for each piece.
void write_route_gpx(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
