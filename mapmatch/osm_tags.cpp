#include "mapmatch/osm_tags.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace maploop::mapmatch {
namespace {

constexpr double kilometres_an_hour = 1.0 / 3.6;
constexpr double miles_an_hour = 0.44704;
constexpr double foot = 0.3048;  // m
constexpr double walking = 7.0 * kilometres_an_hour;

// Returns the number at the start of a text; nothing if the text starts otherwise.
std::optional<double> leading_number(std::string_view text, std::string_view* rest = nullptr) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  if (rest) *rest = text.substr(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::uint8_t parse_lanes(std::string_view text) {
  return static_cast<std::uint8_t>(std::clamp(leading_number(text).value_or(0.0), 0.0, 20.0));
}

bool any_of(std::string_view value, std::initializer_list<std::string_view> these) {
  return std::find(these.begin(), these.end(), value) != these.end();
}

bool is_yes(std::string_view value) {
  return !value.empty() && value != "no";
}

void set_directions(Road& road, std::string_view oneway) {
  const bool implied = road.road_class == RoadClass::motorway ||
                       road.road_class == RoadClass::motorway_link || road.roundabout;
  if (any_of(oneway, {"-1", "reverse"})) {
    road.forward = false;
  } else if (any_of(oneway, {"yes", "true", "1"}) ||
             (implied && !any_of(oneway, {"no", "false", "0"}))) {
    road.backward = false;
  }
}

}  // namespace

double parse_speed_limit(std::string_view text) {
  if (text == "walk") return walking;
  std::string_view unit;
  const auto value = leading_number(text, &unit);
  if (!value || *value < 0.0 || *value > 300.0) return 0.0;
  return *value * (unit.find("mph") != std::string_view::npos ? miles_an_hour : kilometres_an_hour);
}

double parse_width(std::string_view text) {
  std::string_view unit;
  const auto value = leading_number(text, &unit);
  if (!value) return 0.0;
  const bool feet =
      unit.find("ft") != std::string_view::npos || unit.find('\'') != std::string_view::npos;
  const double metres = *value * (feet ? foot : 1.0);
  return metres >= 1.5 && metres <= 100.0 ? metres : 0.0;
}

std::optional<Road> road_from_tags(std::int64_t way_id, const TagValue& tag) {
  const auto road_class = parse_road_class(tag("highway"));
  if (!road_class || tag("area") == "yes") return {};
  Road road;
  road.way_id = way_id;
  road.road_class = *road_class;
  road.roundabout = any_of(tag("junction"), {"roundabout", "circular"});
  set_directions(road, tag("oneway"));
  // The most specific key has priority.
  for (const char* key : {"motorcar", "motor_vehicle", "vehicle", "access"}) {
    const std::string_view value = tag(key);
    if (value.empty()) continue;
    road.restricted = any_of(value, {"no", "private", "agricultural", "forestry", "delivery"});
    break;
  }
  road.bridge = is_yes(tag("bridge"));
  road.tunnel = is_yes(tag("tunnel"));
  if (const auto layer = leading_number(tag("layer")))
    road.layer = static_cast<std::int8_t>(std::clamp(*layer, -9.0, 9.0));
  road.lanes = parse_lanes(tag("lanes"));
  road.lanes_forward = parse_lanes(tag("lanes:forward"));
  road.lanes_backward = parse_lanes(tag("lanes:backward"));
  road.width = parse_width(tag("width"));
  road.speed_limit = parse_speed_limit(tag("maxspeed"));
  road.name = tag("name");
  if (road.name.empty()) road.name = tag("ref");
  return road;
}

}  // namespace maploop::mapmatch
