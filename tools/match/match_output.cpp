#include "tools/match/match_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>

#include "mapmatch/lanes.h"
#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/gpx_text.h"

namespace maploop::match {
namespace {

double seconds_of(const mapmatch::VehicleFix& fix) {
  return to_seconds(fix.stamp.time_since_epoch());
}

bool on_road(const mapmatch::MatchResult& r) {
  return r.on_road && r.refusal == mapmatch::FixRefusal::none;
}

std::string_view phase_of(const mapmatch::MatchResult& r) {
  return r.refusal == mapmatch::FixRefusal::none ? to_string(r.phase)
                                                 : std::string_view("not used");
}

LanePosition lane_of(const MatchedTrack& track, std::size_t i,
                     const mapmatch::RoadNetwork& network) {
  const mapmatch::VehicleFix& fix = track.fixes[i];
  const mapmatch::MatchResult& r = track.results[i];
  return mapmatch::lane_on(network, r.link, r.point, network.to_local(fix.position), fix.covariance,
                           track.lane_sigma);
}

}  // namespace

std::vector<std::size_t> MatchedTrack::used() const {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (results[i].refusal == mapmatch::FixRefusal::none) used.push_back(i);
  return used;
}

void write_match_csv(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network) {
  std::string text =
      "t,lat,lon,phase,way_id,node_a,node_b,matched_lat,matched_lon,azimuth_deg,likelihood,p_"
      "link,lanes,lane,p_lane\n";
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::VehicleFix& fix = track.fixes[i];
    const mapmatch::MatchResult& r = track.results[i];
    text += fmt::format("{:.6f},{:.9f},{:.9f},{},", seconds_of(fix), degrees(fix.position.latitude),
                        degrees(fix.position.longitude), phase_of(r));
    if (!on_road(r)) {
      text += ",,,,,,,,,,\n";
      continue;
    }
    const auto [a, b] = network.nodes(r.link, r.point.vertex);
    const Geodetic matched = network.to_geodetic(r.point.position);
    const double azimuth = degrees(r.point.azimuth());
    text += fmt::format("{},{},{},{:.9f},{:.9f},{:.2f},{:.2f},{:.4f},",
                        network.road_at(r.point.vertex).way_id, a, b, degrees(matched.latitude),
                        degrees(matched.longitude), azimuth < 0.0 ? azimuth + 360.0 : azimuth,
                        r.likelihood, r.probability);
    const LanePosition lane = lane_of(track, i, network);
    text += lane.lanes > 0 ? fmt::format("{},{},{:.4f}\n", lane.lanes, lane.lane, lane.probability)
                           : ",,\n";
  }
  evaluation::write_text(file, text);
}

void write_match_geojson(const std::filesystem::path& file, const MatchedTrack& track,
                         const mapmatch::RoadNetwork& network) {
  nlohmann::json features = nlohmann::json::array();
  nlohmann::json line = nlohmann::json::array();
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::VehicleFix& fix = track.fixes[i];
    const mapmatch::MatchResult& r = track.results[i];
    nlohmann::json properties{
        {"t", seconds_of(fix)}, {"phase", phase_of(r)}, {"reason", explanation(r, network)}};
    if (on_road(r)) {
      const Geodetic matched = network.to_geodetic(r.point.position);
      line.push_back({degrees(matched.longitude), degrees(matched.latitude)});
      const auto [a, b] = network.nodes(r.link, r.point.vertex);
      properties["way_id"] = network.road_at(r.point.vertex).way_id;
      properties["node_a"] = a;
      properties["node_b"] = b;
      properties["p_link"] = r.probability;
      if (const LanePosition lane = lane_of(track, i, network); lane.lanes > 0) {
        properties["lanes"] = lane.lanes;
        properties["lane"] = lane.lane;
        properties["p_lane"] = lane.probability;
      }
    }
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Point"},
           {"coordinates", {degrees(fix.position.longitude), degrees(fix.position.latitude)}}}},
         {"properties", properties}});
  }
  features.push_back({{"type", "Feature"},
                      {"geometry", {{"type", "LineString"}, {"coordinates", line}}},
                      {"properties", {{"name", "matched positions"}}}});
  evaluation::write_text(file,
                         nlohmann::json{{"type", "FeatureCollection"}, {"features", features}}.dump(
                             1, ' ', false, nlohmann::json::error_handler_t::replace) +
                             "\n");
}

void write_match_gpx(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network) {
  std::string text = gpx_begin("matched positions") + "<trkseg>\n";
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::MatchResult& r = track.results[i];
    if (!on_road(r)) {
      if (i > 0 && on_road(track.results[i - 1])) text += "</trkseg><trkseg>\n";
      continue;
    }
    text += gpx_point(network.to_geodetic(r.point.position), track.fixes[i].stamp);
  }
  evaluation::write_text(file, text + "</trkseg>\n" + std::string(gpx_end));
}

}  // namespace maploop::match
