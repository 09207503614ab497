// One way the vehicle may have gone, and where on it it is.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// The link the vehicle is on, the one it came from and, near its end, the one it will take. State
// of its Kalman filter: s (m along the link, as driven) and the offset (m, east and north) of the
// fixes from the road, which the map's error and the slow part of the fixes' errors make up.
struct PathHypothesis {
  DirectedLink link, previous, next;
  bool has_previous = false, has_next = false;
  bool turned_round = false;  // a hypothesis of turning round here was made of it
  double s = 0.0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double log_weight = 0.0;  // of its share among all
  // How badly it fits at the last fix, in sigmas squared.
  double offset_misfit = 0.0, azimuth_misfit = 0.0;

  double sigma() const { return std::sqrt(covariance(0, 0)); }
};

template <class Archive>
void archive(Archive& ar, PathHypothesis& h) {
  ar(h.link, h.previous, h.next, h.has_previous, h.has_next, h.turned_round, h.s, h.offset,
     h.covariance, h.log_weight, h.offset_misfit, h.azimuth_misfit);
}

// A place on its path: before the link and behind it on the links that it has there.
struct PathPoint {
  DirectedLink link;
  double s = 0.0;  // on that link
  LinkPoint point;
};

PathPoint place_on_path(const RoadNetwork& network, const PathHypothesis& h, double s);

}  // namespace maploop::mapmatch
