// Links near a fix.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mapmatch/road_network.h"

namespace maploop::mapmatch {

// A link and the place on it that is nearest to a fix.
struct NearLink {
  DirectedLink link;
  double along = 0.0;     // m, as driven
  double distance = 0.0;  // m
  LinkPoint point;
};

// A fixed number of candidates, kept between calls.
struct NearLinks {
  static constexpr std::size_t capacity = 48;
  std::array<NearLink, capacity> links{};
  std::size_t count = 0;
  std::size_t left_out = 0;  // further away than those that are here

  std::span<const NearLink> all() const { return {links.data(), count}; }
};

// The error ellipse of 99 % of a fix, grown by what the map and the road's width add.
struct ErrorEllipse {
  double major = 0.0, minor = 0.0;                       // m
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // of the major axis

  ErrorEllipse(const Eigen::Matrix2d& covariance, double margin);
  bool contains(const Eigen::Vector2d& offset) const;
  Box box(const Eigen::Vector2d& center) const;
};

// Each link once, as stored (forward), the nearest first; where there are more than fit, the
// nearest.
void find_near_links(const RoadNetwork& network, const Eigen::Vector2d& place,
                     const ErrorEllipse& region, NearLinks& near);

}  // namespace maploop::mapmatch
