// This is a box of latitudes and longitudes.
#pragma once

#include <algorithm>

namespace maploop::mapmatch {

// The box is in degrees, WGS84.
struct GeographicBox {
  double west = -180.0, south = -90.0, east = 180.0, north = 90.0;
};

// This box is empty: joined with another one, it gives that one.
constexpr GeographicBox no_area{180.0, 90.0, -180.0, -90.0};

// Returns the smallest box that contains both.
constexpr GeographicBox joined(const GeographicBox& a, const GeographicBox& b) {
  return {std::min(a.west, b.west), std::min(a.south, b.south), std::max(a.east, b.east),
          std::max(a.north, b.north)};
}

}  // namespace maploop::mapmatch
