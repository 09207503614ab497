// A road holds the attributes of an OpenStreetMap way.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace maploop::mapmatch {

// These are the drivable values of `highway`, the most important first.
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
  road,  // class unknown to the mapper
  service,
  track,
};

// Returns the value of `highway` for a class.
std::string_view to_string(RoadClass road_class);
// Returns the class for a value of `highway`; nothing if cars cannot drive on it.
std::optional<RoadClass> parse_road_class(std::string_view highway);

// Holds the attributes that are the same along one way of the map.
struct Road {
  std::int64_t way_id = 0;                 // OpenStreetMap's
  RoadClass road_class = RoadClass::road;  // from `highway`
  bool forward = true;                     // may be driven from its first node to its last
  bool backward = true;                    // may be driven from its last node to its first
  bool restricted = false;                 // no public access by car, such as access=private
  bool roundabout = false;  // also other circular junctions; one-way unless tagged otherwise
  bool bridge = false;      // it is on a bridge
  bool tunnel = false;      // it is in a tunnel
  std::int8_t layer = 0;    // level above (positive) or below others that it crosses; 0: ground
  std::uint8_t lanes = 0;   // of both directions; 0: unknown
  std::uint8_t lanes_forward = 0, lanes_backward = 0;  // along the way and against it; 0: unknown
  double width = 0.0;                                  // m, of the carriageway; 0: unknown
  double speed_limit = 0.0;                            // m/s; 0: unknown or unlimited
  std::string name;                                    // name, or reference ("B 3")
};

template <class Archive>
void archive(Archive& ar, Road& r) {
  ar(r.way_id, r.road_class, r.forward, r.backward, r.restricted, r.roundabout, r.bridge, r.tunnel,
     r.layer, r.lanes, r.lanes_forward, r.lanes_backward, r.width, r.speed_limit, r.name);
}

// Returns the usual width of a lane in m (Richtlinien fuer die Anlage von Stadtstrassen, 2006: 3.25
// m, and 2.75 m on roads with slow traffic).
double usual_lane_width(const Road& road);

// Returns half the width of the traffic lanes in m, from their number, or the usual number for the
// class, and their usual width.
double half_width(const Road& road);

}  // namespace maploop::mapmatch
