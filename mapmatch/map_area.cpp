#include "mapmatch/map_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "msgs/frames.h"

namespace maploop::mapmatch {

GeographicBox area_of(const RoadNetwork& network) {
  GeographicBox box{180.0, 90.0, -180.0, -90.0};
  for (const Vertex& v : network.data().vertices) {
    const Geodetic place = network.to_geodetic(v.position());
    box.west = std::min(box.west, degrees(place.longitude));
    box.east = std::max(box.east, degrees(place.longitude));
    box.south = std::min(box.south, degrees(place.latitude));
    box.north = std::max(box.north, degrees(place.latitude));
  }
  return box;
}

bool covers(const GeographicBox& box, const Geodetic& place, double margin) {
  constexpr double metres_a_degree = 111'200.0;
  const double latitude = degrees(place.latitude), longitude = degrees(place.longitude);
  const double north = margin / metres_a_degree;
  const double east = north / std::max(std::cos(place.latitude), 0.01);
  return latitude >= box.south - north && latitude <= box.north + north &&
         longitude >= box.west - east && longitude <= box.east + east;
}

std::string to_text(const GeographicBox& box) {
  const auto range = [](double low, double high, char plus, char minus) {
    std::array<char, 64> text{};
    if (low < 0.0 && high > 0.0) {
      std::snprintf(text.data(), text.size(), "%.4f %c to %.4f %c", -low, minus, high, plus);
    } else if (high <= 0.0) {
      std::snprintf(text.data(), text.size(), "%.4f to %.4f %c", -high, -low, minus);
    } else {
      std::snprintf(text.data(), text.size(), "%.4f to %.4f %c", low, high, plus);
    }
    return std::string(text.data());
  };
  return range(box.south, box.north, 'N', 'S') + ", " + range(box.west, box.east, 'E', 'W');
}

}  // namespace maploop::mapmatch
