// The tags of an OpenStreetMap way are interpreted here (wiki.openstreetmap.org/wiki/Key:oneway,
// Key:access, Key:maxspeed).
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "mapmatch/road.h"

namespace maploop::mapmatch {

// Returns the value of a key; empty if the way does not have the key.
using TagValue = std::function<std::string_view(const char* key)>;

// Returns the road that the tags describe; nothing if no car may drive there.
std::optional<Road> road_from_tags(std::int64_t way_id, const TagValue& tag);

// Returns m/s for values such as "50", "30 mph" and "walk"; 0 if there is no number ("none",
// "DE:urban").
double parse_speed_limit(std::string_view text);

// Returns metres for values such as "7.5", "7.5 m" and "20 ft"; 0 if there is no number, or one
// that is no width of a road.
double parse_width(std::string_view text);

}  // namespace maploop::mapmatch
