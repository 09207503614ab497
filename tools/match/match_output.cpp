#include "tools/match/match_output.h"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tools/evaluation/text_file.h"

namespace maploop::match {
namespace {

[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  std::array<char, 256> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  text += line.data();
}

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

}  // namespace

void write_match_csv(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network) {
  std::string text =
      "t,lat,lon,phase,way_id,node_a,node_b,matched_lat,matched_lon,azimuth_deg,likelihood,p_"
      "link\n";
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::VehicleFix& fix = track.fixes[i];
    const mapmatch::MatchResult& r = track.results[i];
    append(text, "%.6f,%.9f,%.9f,%s,", seconds_of(fix), degrees(fix.position.latitude),
           degrees(fix.position.longitude), std::string(phase_of(r)).c_str());
    if (!on_road(r)) {
      text += ",,,,,,,\n";
      continue;
    }
    const auto [a, b] = network.nodes(r.link, r.point.vertex);
    const Geodetic matched = network.to_geodetic(r.point.position);
    const double azimuth = degrees(r.point.azimuth());
    append(text, "%lld,%lld,%lld,%.9f,%.9f,%.2f,%.2f,%.4f\n",
           static_cast<long long>(network.road_at(r.point.vertex).way_id),
           static_cast<long long>(a), static_cast<long long>(b), degrees(matched.latitude),
           degrees(matched.longitude), azimuth < 0.0 ? azimuth + 360.0 : azimuth, r.likelihood,
           r.probability);
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
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"maploop\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<trk><name>matched positions</name><trkseg>\n";
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::MatchResult& r = track.results[i];
    if (!on_road(r)) {
      if (i > 0 && on_road(track.results[i - 1])) text += "</trkseg><trkseg>\n";
      continue;
    }
    const Geodetic matched = network.to_geodetic(r.point.position);
    std::string time = format_time(track.fixes[i].stamp);
    time[time.find(' ')] = 'T';
    append(text, "<trkpt lat=\"%.9f\" lon=\"%.9f\"><time>%sZ</time></trkpt>\n",
           degrees(matched.latitude), degrees(matched.longitude), time.c_str());
  }
  evaluation::write_text(file, text + "</trkseg></trk>\n</gpx>\n");
}

}  // namespace maploop::match
