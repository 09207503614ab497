// What the tags of OpenStreetMap say of a way (wiki.openstreetmap.org/wiki/Key:oneway, Key:access,
// Key:maxspeed).
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "mapmatch/road.h"

namespace maploop::mapmatch {

// The value of a key; empty where the way has none.
using TagValue = std::function<std::string_view(const char* key)>;

// The road that the tags describe; none where no car drives.
std::optional<Road> road_from_tags(std::int64_t way_id, const TagValue& tag);

// "50", "30 mph", "walk"; 0 where there is no number to be had ("none", "DE:urban").
double parse_speed_limit(std::string_view text);

}  // namespace maploop::mapmatch
