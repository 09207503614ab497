// Finds the streets near a place.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "tools/simulate/town/streets.h"

namespace maploop::simulate {

// The position of a place relative to a street.
struct StreetPlace {
  const Street* street = nullptr;
  double along = 0.0;  // m from the street's start
  double left = 0.0;   // m from its centreline
  double edge = 0.0;   // m from its kerb, negative on the road
};

class StreetIndex {
 public:
  // Covers places up to `reach` metres from a kerb. The streets must outlive it.
  StreetIndex(const Streets& streets, double reach);

  struct Nearest {
    StreetPlace first, second;  // nearest by `edge`; `street` may be null
  };
  Nearest nearest(const Eigen::Vector2d& place) const;
  // Returns m to the nearest kerb, negative on a road; at most the reach.
  double to_kerb(const Eigen::Vector2d& place) const;

  const Eigen::Vector2d& least() const { return least_; }  // corners of the covered area
  Eigen::Vector2d most() const;

 private:
  // A segment of a centreline.
  struct Segment {
    const Street* street = nullptr;
    Eigen::Vector2d begin, direction;  // `direction` is a unit vector
    double along = 0.0, length = 0.0;  // m: `along` at its start, and its length
  };
  std::span<const Segment> cell(const Eigen::Vector2d& place) const;

  double reach_;
  Eigen::Vector2d least_ = Eigen::Vector2d::Zero();
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::vector<Segment>> cells_;  // segments of the same street are adjacent
};

}  // namespace maploop::simulate
