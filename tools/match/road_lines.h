// Draws roads as lines of a picture.
#pragma once

#include <vector>

#include "mapmatch/road_network.h"
#include "tools/web/plot.h"

namespace maploop::match {

// Returns the bounding box of the places that are finite, with a margin; m, in a network's own
// frame.
mapmatch::Box box_about(const std::vector<Eigen::Vector2d>& places, double margin);

// Returns the links within `reach` metres of the bounding box of `lines`, in metres east and north
// of `origin` like these. Returns nothing if the lines are empty.
std::vector<web::Line> road_lines(const mapmatch::RoadNetwork& network, const Geodetic& origin,
                                  const std::vector<web::Line>& lines, double reach);

}  // namespace maploop::match
