// Writes routes to files.
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "tools/command/json_output.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/driven_route.h"
#include "tools/match/gpx_text.h"

namespace maploop::match {
namespace {

using nlohmann::json;

json lon_lat(const mapmatch::RoadNetwork& network, const Eigen::Vector2d& place) {
  const Geodetic g = network.to_geodetic(place);
  return {degrees(g.longitude), degrees(g.latitude)};
}

// The places of a step, as driven.
std::vector<Eigen::Vector2d> places(const RouteStep& step, const mapmatch::RoadNetwork& network) {
  std::vector<Eigen::Vector2d> places{network.at(step.link, step.from).position};
  const auto shape = network.shape(step.link.link);
  const double length = network.link(step.link.link).length;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const mapmatch::Vertex& v = shape[step.link.forward ? k : shape.size() - 1 - k];
    const double along = step.link.forward ? v.along : length - v.along;
    if (along > step.from && along < step.to) places.push_back(v.position());
  }
  places.push_back(network.at(step.link, step.to).position);
  return places;
}

json line_string(std::span<const RouteStep> steps, const mapmatch::RoadNetwork& network) {
  json points = json::array();
  for (const RouteStep& step : steps) {
    for (const Eigen::Vector2d& place : places(step, network))
      points.push_back(lon_lat(network, place));
  }
  return {{"type", "LineString"}, {"coordinates", points}};
}

json way(const RouteStep& step, const mapmatch::RoadNetwork& network) {
  const auto& road = network.road_at(network.at(step.link, step.from).vertex);
  const auto node = [&](std::uint32_t junction) {
    return network.data().junctions[junction].node_id;
  };
  return {{"way_id", road.way_id},
          {"name", road.name},
          {"from_node", node(network.start_junction(step.link))},
          {"to_node", node(network.end_junction(step.link))},
          {"distance", step.length()},
          {"entered", to_seconds(step.entered.time_since_epoch())},
          {"left", to_seconds(step.left.time_since_epoch())},
          {"probability", step.probability}};
}

// A matching without its legs.
json matching(const DrivenRoute::Piece& piece, const mapmatch::RoadNetwork& network) {
  double length = 0.0, sure = 0.0;
  json ways = json::array();
  for (const RouteStep& step : piece) {
    ways.push_back(way(step, network));
    length += step.length();
    sure += step.length() * step.probability;
  }
  const double seconds = to_seconds(piece.back().left - piece.front().entered);
  return {{"confidence", length > 0.0 ? sure / length : piece.front().probability},
          {"distance", length},
          {"duration", seconds},
          {"weight", seconds},
          {"weight_name", "duration"},
          {"geometry", line_string(piece, network)},
          {"ways", ways},
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

void write_route_geojson(const std::filesystem::path& file, const MatchedTrack& track,
                         const mapmatch::RoadNetwork& network) {
  json features = json::array();
  const DrivenRoute route = driven_route(track, network);
  for (std::size_t piece = 0; piece < route.pieces.size(); ++piece) {
    for (const RouteStep& step : route.pieces[piece]) {
      json properties = way(step, network);
      properties["piece"] = piece;
      features.push_back({{"type", "Feature"},
                          {"geometry", line_string({&step, 1}, network)},
                          {"properties", properties}});
    }
  }
  tools::write_json_file(file, {{"type", "FeatureCollection"}, {"features", features}});
}

void write_route_gpx(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network) {
  std::string text = gpx_begin("route");
  for (const DrivenRoute::Piece& piece : driven_route(track, network).pieces) {
    text += "<trkseg>\n";
    for (const RouteStep& step : piece) {
      // The time at a place between two fixes is that of its share of the way.
      const std::vector<Eigen::Vector2d> along = places(step, network);
      double driven = 0.0;
      for (std::size_t i = 0; i < along.size(); ++i) {
        if (i > 0) driven += (along[i] - along[i - 1]).norm();
        const double share = step.length() > 0.0 ? std::min(1.0, driven / step.length()) : 0.0;
        text +=
            gpx_point(network.to_geodetic(along[i]),
                      step.entered + from_seconds(share * to_seconds(step.left - step.entered)));
      }
    }
    text += "</trkseg>\n";
  }
  evaluation::write_text(file, text + std::string(gpx_end));
}

}  // namespace maploop::match
