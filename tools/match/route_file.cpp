#include <nlohmann/json.hpp>
#include <string>

#include "msgs/frames.h"
#include "tools/command/json_output.h"
#include "tools/match/driven_route.h"

namespace maploop::match {
namespace {

using nlohmann::json;

json lon_lat(const mapmatch::RoadNetwork& network, const Eigen::Vector2d& place) {
  const Geodetic g = network.to_geodetic(place);
  return {degrees(g.longitude), degrees(g.latitude)};
}

json geometry(const DrivenRoute::Piece& piece, const mapmatch::RoadNetwork& network) {
  json points = json::array();
  for (const RouteStep& step : piece) {
    points.push_back(lon_lat(network, network.at(step.link, step.from).position));
    const auto shape = network.shape(step.link.link);
    const double length = network.link(step.link.link).length;
    for (std::size_t k = 0; k < shape.size(); ++k) {
      const mapmatch::Vertex& v = shape[step.link.forward ? k : shape.size() - 1 - k];
      const double along = step.link.forward ? v.along : length - v.along;
      if (along > step.from && along < step.to) points.push_back(lon_lat(network, v.position()));
    }
    points.push_back(lon_lat(network, network.at(step.link, step.to).position));
  }
  return {{"type", "LineString"}, {"coordinates", points}};
}

json ways(const DrivenRoute::Piece& piece, const mapmatch::RoadNetwork& network) {
  json ways = json::array();
  for (const RouteStep& step : piece) {
    const auto& road = network.road_at(network.at(step.link, step.from).vertex);
    const auto node = [&](std::uint32_t junction) {
      return network.data().junctions[junction].node_id;
    };
    ways.push_back({{"way_id", road.way_id},
                    {"name", road.name},
                    {"from_node", node(network.start_junction(step.link))},
                    {"to_node", node(network.end_junction(step.link))},
                    {"distance", step.length()},
                    {"entered", to_seconds(step.entered.time_since_epoch())},
                    {"left", to_seconds(step.left.time_since_epoch())},
                    {"probability", step.probability}});
  }
  return ways;
}

// A matching without its legs.
json matching(const DrivenRoute::Piece& piece, const mapmatch::RoadNetwork& network) {
  double length = 0.0, sure = 0.0;
  for (const RouteStep& step : piece) {
    length += step.length();
    sure += step.length() * step.probability;
  }
  const double seconds = to_seconds(piece.back().left - piece.front().entered);
  return {{"confidence", length > 0.0 ? sure / length : piece.front().probability},
          {"distance", length},
          {"duration", seconds},
          {"weight", seconds},
          {"weight_name", "duration"},
          {"geometry", geometry(piece, network)},
          {"ways", ways(piece, network)},
          {"legs", json::array()}};
}

}  // namespace

void write_route(const std::filesystem::path& file, const MatchedTrack& track,
                 const mapmatch::RoadNetwork& network) {
  const DrivenRoute route = driven_route(track, network);
  json matchings = json::array(), tracepoints = json::array();
  for (const DrivenRoute::Piece& piece : route.pieces)
    matchings.push_back(matching(piece, network));
  std::optional<std::size_t> before;  // the last fix on the route
  std::size_t in_piece = 0;
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const auto& place = route.places[i];
    if (!place) {
      tracepoints.push_back(nullptr);
      continue;
    }
    const mapmatch::MatchResult& r = track.results[i];
    const bool goes_on = before && route.places[*before]->piece == place->piece;
    in_piece = goes_on ? in_piece + 1 : 0;
    if (goes_on) {
      const double seconds = to_seconds(track.fixes[i].stamp - track.fixes[*before].stamp);
      const double metres = std::max(0.0, place->distance - route.places[*before]->distance);
      matchings[place->piece]["legs"].push_back({{"distance", metres},
                                                 {"duration", seconds},
                                                 {"weight", seconds},
                                                 {"summary", ""},
                                                 {"steps", json::array()}});
    }
    const auto others = std::count_if(
        r.candidates.begin(), r.candidates.begin() + static_cast<std::ptrdiff_t>(r.candidate_count),
        [&](const mapmatch::MatchCandidate& c) { return c.probability > 0.01; });
    tracepoints.push_back(
        {{"location", lon_lat(network, r.point.position)},
         {"name", network.road_at(r.point.vertex).name},
         {"distance", (network.to_local(track.fixes[i].position) - r.point.position).norm()},
         {"matchings_index", place->piece},
         {"waypoint_index", in_piece},
         {"alternatives_count", std::max<std::ptrdiff_t>(0, others - 1)}});
    before = i;
  }
  tools::write_json_file(file, {{"code", route.pieces.empty() ? "NoMatch" : "Ok"},
                                {"matchings", matchings},
                                {"tracepoints", tracepoints}});
}

}  // namespace maploop::match
