// This file defines what is published where a drive contradicts the road map.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "msgs/local_frame.h"
#include "msgs/map_match.h"
#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop {

// States how a map contradicts a drive.
enum class DoubtKind : std::uint8_t {
  missing_road,     // the vehicle drove where the map has no road
  wrong_direction,  // it drove along a link against its one-way direction
  forbidden_turn,   // it turned from one link into another, which the map forbids
  shifted_road,     // it drove beside the carriageway of the link on which it was
};

constexpr auto names_of(DoubtKind) {
  return names_up_to<DoubtKind::shifted_road>(
      {"missing road", "wrong direction", "forbidden turn", "shifted road"});
}

// This is a place of the map that a drive contradicts. `stamp` is when the contradiction ended.
struct MapDoubt : Sample {
  static constexpr std::size_t max_points = 64;  // of a track

  // A segment of an OpenStreetMap way, as driven, and the link that it is part of.
  struct Segment {
    DirectedLink link;        // index in the road network in use
    std::int64_t way_id = 0;  // OpenStreetMap's; 0: there is no segment
    std::int64_t node_a = 0;  // the segment is driven from here
    std::int64_t node_b = 0;  // to here

    void archive(auto& ar) { ar(link, way_id, node_a, node_b); }
  };

  DoubtKind kind = DoubtKind::missing_road;  // how the map contradicts the drive
  Time begin{};                              // when the contradiction began
  double probability = 0.0;                  // that the map is wrong here, from this drive alone
  double length = 0.0;                       // m driven in contradiction
  Segment from;  // driven in contradiction; missing road, turn: driven before it
  Segment to;    // missing road, turn: driven after it
  // The vehicle was so many metres beside the line of a shifted road, positive to its right.
  double offset = std::numeric_limits<double>::quiet_NaN();
  double offset_sigma = std::numeric_limits<double>::quiet_NaN();  // m, of the offset
  std::array<Geodetic, max_points> track{};  // where the vehicle drove; heights are 0
  std::size_t track_count = 0;               // valid points at the front of `track`

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), kind, begin, probability, length, from, to, offset,
       offset_sigma, track, track_count);
  }
};

}  // namespace maploop
