// These functions describe where on the Earth the roads of a network are.
#pragma once

#include <string>

#include "mapmatch/geographic_box.h"
#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// Returns the smallest box, in degrees, that contains every vertex of the network.
GeographicBox area_of(const RoadNetwork& network);

// Returns the box that reaches `metres` from a place to each side. Across the 180th meridian its
// west is greater than its east.
GeographicBox around(const Geodetic& place, double metres);

// Returns whether the place is in the box or at most `margin` metres outside it.
bool covers(const GeographicBox& box, const Geodetic& place, double margin);

// Returns text such as "48.9700 to 49.0700 N, 8.3000 to 8.5000 E".
std::string to_text(const GeographicBox& box);

}  // namespace maploop::mapmatch
