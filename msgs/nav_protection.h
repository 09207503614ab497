// This file defines how far the fused position may be wrong.
#pragma once

#include <cstdint>

#include "msgs/sample.h"

namespace maploop {

// Compares the fused position with one that does without an aid.
struct Separation {
  bool known = false;                            // whether there is such a position
  double along = 0.0, across = 0.0;              // m, distance of the two
  double along_sigma = 0.0, across_sigma = 0.0;  // m, of the position without the aid

  void archive(auto& ar) { ar(known, along, across, along_sigma, across_sigma); }
};

// These are the protection levels of the NavState of the same stamp, along and across its direction
// of travel; for a vehicle that stands, both are the larger one of east and north.
struct NavProtection : Sample {
  static constexpr std::uint64_t every = 10;  // of so many states, one has levels

  // An aid lastingly contradicts the others, which HEALTH says: the levels do not hold.
  bool doubted = false;
  double risk = 0.0;            // probability of an error beyond one level, at one moment
  double along = 0.0;           // m
  double across = 0.0;          // m, to either side
  double horizontal = 0.0;      // m, of the distance from the true position, with the same risk
  Separation without_map;       // since the older map-free copy of the filter was made
  Separation without_gnss;      // odometry's way from where the vehicle was before
  Separation without_odometry;  // fixes of the last seconds

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), doubted, risk, along, across, horizontal, without_map,
       without_gnss, without_odometry);
  }
};

}  // namespace maploop
