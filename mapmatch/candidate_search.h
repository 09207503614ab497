// This search finds the links near a fix.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// Holds a link and the point on it that is nearest to a fix.
struct NearLink {
  DirectedLink link;
  double along = 0.0;     // m from where the link is entered
  double distance = 0.0;  // m
  LinkPoint point;
};

// Holds at most `capacity` candidates; the object is reused between calls.
struct NearLinks {
  static constexpr std::size_t capacity = 48;
  std::array<NearLink, capacity> links{};
  std::size_t count = 0;
  std::size_t left_out =
      0;  // times a link was dropped for a nearer one; a link may count more than once

  std::span<const NearLink> all() const { return {links.data(), count}; }
};

// Describes the 99 % error ellipse of a fix, enlarged by `margin` (m) for the error of the map and
// the width of the road.
struct ErrorEllipse {
  double major = 0.0, minor = 0.0;                       // m
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // of the major axis

  ErrorEllipse(const Eigen::Matrix2d& covariance, double margin);
  bool contains(const Eigen::Vector2d& offset) const;
  Box box(const Eigen::Vector2d& center) const;
};

// Lists each link in the region once, in its stored (forward) direction, nearest first. If more
// links than `capacity` are in the region, keeps the nearest. `place` is the fix in the network's
// metres.
void find_near_links(const RoadNetwork& network, const Eigen::Vector2d& place,
                     const ErrorEllipse& region, NearLinks& near);

}  // namespace maploop::mapmatch
