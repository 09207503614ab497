#include "mapmatch/map_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

struct Reach {
  double north = 0.0, east = 0.0;  // degrees
};

Reach reach_of(double metres, const Geodetic& place) {
  constexpr double metres_a_degree = 111'200.0;
  const double north = metres / metres_a_degree;
  return {north, north / std::max(std::cos(place.latitude), 0.01)};
}

}  // namespace

GeographicBox area_of(const RoadNetwork& network) {
  GeographicBox box = no_area;
  for (const Vertex& v : network.data().vertices) {
    const Geodetic place = network.to_geodetic(v.position());
    const double longitude = degrees(place.longitude), latitude = degrees(place.latitude);
    box = joined(box, {longitude, latitude, longitude, latitude});
  }
  return box;
}

GeographicBox around(const Geodetic& place, double metres) {
  const double latitude = degrees(place.latitude), longitude = degrees(place.longitude);
  const auto [north, east] = reach_of(metres, place);
  return {std::remainder(longitude - east, 360.0), std::max(latitude - north, -90.0),
          std::remainder(longitude + east, 360.0), std::min(latitude + north, 90.0)};
}

bool covers(const GeographicBox& box, const Geodetic& place, double margin) {
  const double latitude = degrees(place.latitude), longitude = degrees(place.longitude);
  const auto [north, east] = reach_of(margin, place);
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
