// The lanes of a road in the direction of travel, and which of them the vehicle is in.
#pragma once

#include "mapmatch/road_network.h"
#include "msgs/map_match.h"

namespace maploop::mapmatch {

// Describes the lanes of one direction, as a driver sees them. Lanes are numbered from 1 on the
// left to `count` on the right, as OpenStreetMap's tags list them.
struct Lanes {
  int count = 0;       // in the direction of travel; 0: the map does not tell
  double width = 0.0;  // m, of each lane
  double left = 0.0;   // m to the right of the road's line, of the left edge of the first lane

  // Returns how far to the right of the road's line the middle of a lane is, m.
  double middle(int lane) const { return left + (lane - 0.5) * width; }
};

// Returns the lanes of a road that is driven in the direction of its way (`forward`) or against it.
// The road's line is the middle of its carriageway, whose width is the tagged one, or else the
// usual one for the class. There are none if the tags are missing or contradict each other.
Lanes lanes_of(const Road& road, bool forward, bool left_hand_traffic);

// Returns the likeliest lane of a vehicle that is `cross_track` m to the right of the road's line,
// given that it is on this road. `sigma` (m) is the standard deviation of its distance from the
// lane's middle: (21) of METHOD.md.
LanePosition lane_at(const Lanes& lanes, double cross_track, double sigma);

// Returns the same for a place (m, in the network's frame, with its covariance in m^2) that was
// matched to a point of a link. `line_sigma` (m) is MatchParameters::lane_sigma.
LanePosition lane_on(const RoadNetwork& network, DirectedLink link, const LinkPoint& point,
                     const Eigen::Vector2d& place, const Eigen::Matrix2d& covariance,
                     double line_sigma);

}  // namespace maploop::mapmatch
