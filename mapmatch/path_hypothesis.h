// A path hypothesis is one possible path of the vehicle and its position on it.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>

#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// Holds the link of the vehicle, the one before it and, near its end, the one that it will take.
// The state of its Kalman filter is s (m along the link, as driven) and the offset (m, east and
// north) of the fixes from the road, which consists of the map's error and the slow part of the
// fixes' errors.
struct PathHypothesis {
  static constexpr std::uint32_t no_parent = 0xffffffff;  // it was new at the last fix

  DirectedLink link, previous, next;
  bool has_previous = false, has_next = false;
  bool turned_round = false;  // a U-turn hypothesis was already derived from it here
  double s = 0.0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double log_weight = 0.0;  // log of its share among all hypotheses
  double trust = 0.0;       // -ln odds that this is a road that the map lacks, if the link fits
  // These are its misfits at the last fix, in sigmas squared.
  double offset_misfit = 0.0, azimuth_misfit = 0.0;
  // The index that its path had among the hypotheses before the last fix; it is not archived.
  std::uint32_t parent = no_parent;

  double sigma() const { return std::sqrt(covariance(0, 0)); }
};

template <class Archive>
void archive(Archive& ar, PathHypothesis& h) {
  ar(h.link, h.previous, h.next, h.has_previous, h.has_next, h.turned_round, h.s, h.offset,
     h.covariance, h.log_weight, h.trust, h.offset_misfit, h.azimuth_misfit);
}

// This is a place on a hypothesis's path: on its link or, outside it, on the previous or next link
// if known.
struct PathPoint {
  DirectedLink link;
  double s = 0.0;  // m along that link
  LinkPoint point;
};

PathPoint place_on_path(const RoadNetwork& network, const PathHypothesis& h, double s);

}  // namespace maploop::mapmatch
