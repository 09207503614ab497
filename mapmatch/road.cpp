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

}  // namespace maploop::mapmatch
