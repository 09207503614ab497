#include "tools/match/doubts_file.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tools/command/json_output.h"

namespace maploop::match {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json feature(const PooledDoubt& pooled, const mapmatch::RoadNetwork& network) {
  const MapDoubt& doubt = pooled.doubt;
  json line = json::array();
  for (std::size_t i = 0; i < doubt.track_count; ++i)
    line.push_back({degrees(doubt.track[i].longitude), degrees(doubt.track[i].latitude)});
  // A line has two ends.
  if (line.size() == 1) line.push_back(line[0]);
  return {{"type", "Feature"},
          {"geometry", {{"type", "LineString"}, {"coordinates", line}}},
          {"properties",
           {{"kind", to_string(doubt.kind)},
            {"description", explanation(doubt, network)},
            {"probability", doubt.probability},
            {"times", pooled.times},
            {"drives", pooled.drives},
            {"way", doubt.from.way_id},
            {"node_a", doubt.from.node_a},
            {"node_b", doubt.from.node_b},
            {"to_way", doubt.to.way_id},
            {"to_node_a", doubt.to.node_a},
            {"to_node_b", doubt.to.node_b},
            {"length_m", doubt.length},
            {"offset_m", number(doubt.offset)},
            {"offset_sigma_m", number(doubt.offset_sigma)}}}};
}

std::int64_t read_id(const json& value) {
  if (!value.is_number_integer()) throw std::runtime_error("an id is not a whole number");
  return value.get<std::int64_t>();
}

Geodetic read_point(const json& point) {
  const double longitude = point.at(0).get<double>(), latitude = point.at(1).get<double>();
  if (!(std::abs(latitude) <= 90.0 && std::abs(longitude) <= 180.0))
    throw std::runtime_error("a point is not a longitude and a latitude in degrees");
  return {radians(latitude), radians(longitude), 0.0};
}

MapDoubt read_feature(const json& feature) {
  const json& p = feature.at("properties");
  MapDoubt doubt;
  const auto kind = value_named<DoubtKind>(p.at("kind").get<std::string>());
  if (!kind) throw std::runtime_error("there is no kind '" + p.at("kind").get<std::string>() + "'");
  doubt.kind = *kind;
  doubt.probability = p.at("probability").get<double>();
  doubt.from.way_id = read_id(p.at("way"));
  doubt.to.way_id = read_id(p.at("to_way"));
  doubt.to.node_a = read_id(p.at("to_node_a"));
  for (const json& point : feature.at("geometry").at("coordinates")) {
    if (doubt.track_count == MapDoubt::max_points) {
      throw std::runtime_error("a line has more than " + std::to_string(MapDoubt::max_points) +
                               " points");
    }
    doubt.track[doubt.track_count++] = read_point(point);
  }
  return doubt;
}

// Returns the ways of a link, each once, in the order in which they are stored.
std::vector<std::int64_t> ways_of(DirectedLink link, const mapmatch::RoadNetwork& network) {
  std::vector<std::int64_t> ways;
  for (const mapmatch::Vertex& v : network.shape(link.link)) {
    const std::int64_t way = network.data().roads[v.road].way_id;
    if (ways.empty() || ways.back() != way) ways.push_back(way);
  }
  return ways;
}

}  // namespace

void write_doubts(const std::filesystem::path& file, const std::vector<PooledDoubt>& doubts,
                  const mapmatch::RoadNetwork& network) {
  json features = json::array();
  for (const PooledDoubt& pooled : doubts) {
    features.push_back(feature(pooled, network));
    if (pooled.doubt.kind == DoubtKind::wrong_direction)
      features.back()["properties"]["ways"] = ways_of(pooled.doubt.from.link, network);
  }
  tools::write_json_file(file, {{"type", "FeatureCollection"}, {"features", features}});
}

std::vector<MapDoubt> read_doubts(const std::filesystem::path& file, double min_probability) {
  const std::string text = evaluation::read_text(file);
  try {
    const json parsed = json::parse(text);
    std::vector<MapDoubt> doubts;
    for (const json& f : parsed.at("features")) {
      MapDoubt doubt = read_feature(f);
      if (!(doubt.probability >= min_probability)) continue;
      if (doubt.kind != DoubtKind::wrong_direction) {
        doubts.push_back(doubt);
        continue;
      }
      for (const json& way : f.at("properties").at("ways")) {
        doubt.from.way_id = read_id(way);
        doubts.push_back(doubt);
      }
    }
    return doubts;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + " is not a file of 'maploop map doubts': " + e.what());
  }
}

}  // namespace maploop::match
