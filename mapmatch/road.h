// What OpenStreetMap says of a road.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace maploop::mapmatch {

// The drivable values of `highway`, the most important first.
enum class RoadClass : std::uint8_t {
  motorway,
  motorway_link,
  trunk,
  trunk_link,
  primary,
  primary_link,
  secondary,
  secondary_link,
  tertiary,
  tertiary_link,
  unclassified,
  residential,
  living_street,
  road,  // class not known to the mapper
  service,
  track,
};

std::string_view to_string(RoadClass road_class);
// Of a value of `highway`; none where no car drives on it.
std::optional<RoadClass> parse_road_class(std::string_view highway);

// One way of the map: what is the same all along it.
struct Road {
  std::int64_t way_id = 0;
  RoadClass road_class = RoadClass::road;
  bool forward = true;      // may be driven from its first node to its last
  bool backward = true;     // and the other way round
  bool restricted = false;  // access=no or private, for cars
  bool roundabout = false;
  bool bridge = false;
  bool tunnel = false;
  std::int8_t layer = 0;
  std::uint8_t lanes = 0;    // 0: not said
  double speed_limit = 0.0;  // m/s; 0: not said, or none
  std::string name;          // or its reference ("B 3")
};

template <class Archive>
void archive(Archive& ar, Road& r) {
  ar(r.way_id, r.road_class, r.forward, r.backward, r.restricted, r.roundabout, r.bridge, r.tunnel,
     r.layer, r.lanes, r.speed_limit, r.name);
}

// m, half of what is paved for moving cars: from its lanes, or what is usual for its class
// (Richtlinien fuer die Anlage von Stadtstrassen, 2006: 3.25 m a lane, 2.75 m where cars are slow).
double half_width(const Road& road);

}  // namespace maploop::mapmatch
