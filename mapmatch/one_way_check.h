// This check finds one-way streets whose direction the map itself speaks against, as map editors'
// checks do: a street that makes its ends places where traffic only arrives or only departs, and a
// carriageway whose opposite carriageway is on the wrong side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace maploop::mapmatch {

class RoadNetwork;

// States what the map shows of the direction of one link.
struct OneWayCheck {
  // Fewer junctions were without an exit or without an entry if the link's way ran the other way.
  bool dead_ended = false;
  // The side on which the opposite carriageway of the same name is, as driven: -1 left, 1 right, 0
  // none or both.
  std::int8_t opposite_side = 0;

  // Returns whether the direction is doubtful, where traffic keeps to the left or to the right.
  bool contradicts(bool left_hand_traffic) const {
    return dead_ended || opposite_side == (left_hand_traffic ? -1 : 1);
  }
};

struct OneWayChecks {
  std::vector<OneWayCheck> of_link;       // a link for both directions has nothing to doubt
  std::size_t to_left = 0, to_right = 0;  // links with an opposite carriageway on this side

  // Returns the traffic of most opposite carriageways.
  bool left_hand_traffic() const { return to_right > to_left; }
};

// Takes a microsecond a link.
OneWayChecks check_one_ways(const RoadNetwork& network);

}  // namespace maploop::mapmatch
