#include "mapmatch/road.h"

#include <algorithm>
#include <array>

namespace maploop::mapmatch {
namespace {

constexpr std::array<std::string_view, 16> names{
    "motorway",      "motorway_link",  "trunk",    "trunk_link",    "primary",      "primary_link",
    "secondary",     "secondary_link", "tertiary", "tertiary_link", "unclassified", "residential",
    "living_street", "road",           "service",  "track"};

}  // namespace

std::string_view to_string(RoadClass road_class) {
  const auto index = static_cast<std::size_t>(road_class);
  return index < names.size() ? names[index] : "unknown";
}

std::optional<RoadClass> parse_road_class(std::string_view highway) {
  const auto* const found = std::find(names.begin(), names.end(), highway);
  if (found == names.end()) return {};
  return static_cast<RoadClass>(found - names.begin());
}

double usual_lane_width(const Road& road) {
  return road.road_class >= RoadClass::unclassified ? 2.75 : 3.25;
}

double half_width(const Road& road) {
  const bool fast = road.road_class == RoadClass::motorway || road.road_class == RoadClass::trunk;
  const bool one_way = road.forward != road.backward;
  const bool one_lane = one_way ? !fast : road.road_class >= RoadClass::service;
  const int lanes = road.lanes > 0 ? road.lanes : one_lane ? 1 : 2;
  return 0.5 * lanes * usual_lane_width(road);
}

}  // namespace maploop::mapmatch
