// The true streets of a simulated drive; the map may differ from them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace maploop::simulate {

struct Street {
  std::size_t from = 0, to = 0;             // indices of junctions
  std::vector<Eigen::Vector2d> centreline;  // m, enu; from junction to junction, 2 m apart
  std::vector<double> along;                // m from its start, for each point
  double half_width = 3.5;                  // m
  double speed_limit = 13.9;                // m/s
  bool forward = true, backward = true;     // permitted directions

  double length() const { return along.back(); }
  // Distance in m from the centreline to the right, where a car drives.
  double lane() const { return 0.5 * half_width; }
};

// A street with a driving direction.
struct DirectedStreet {
  std::size_t street = 0;
  bool forward = true;
};

// Returns a number of its own for each directed street, from 0.
inline std::size_t slot_of(DirectedStreet d) {
  return 2 * d.street + (d.forward ? 1U : 0U);
}

struct Streets {
  std::vector<Eigen::Vector2d> junctions;
  std::vector<Street> streets;

  std::size_t end(DirectedStreet d) const {
    return d.forward ? streets[d.street].to : streets[d.street].from;
  }
  // Returns the points in driving order.
  std::vector<Eigen::Vector2d> centreline(DirectedStreet d) const;
  // Returns the directed streets that leave each junction, permitted directions only.
  std::vector<std::vector<DirectedStreet>> exits() const;
};

using Line = std::vector<Eigen::Vector2d>;

// Returns the distance of each point from the first one along the line.
std::vector<double> distances_along(const Line& line);
// Returns a unit vector along the line at a point.
Eigen::Vector2d direction_at(const Line& line, std::size_t i);

// Replaces each value but the first and the last by the mean (1 2 1) / 4 with its neighbours, so
// many times.
template <class Value>
void smooth(std::vector<Value>& values, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<Value> next = values;
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
      next[i] = 0.25 * values[i - 1] + 0.5 * values[i] + 0.25 * values[i + 1];
    values = std::move(next);
  }
}

// The squares of a grid that are near to points.
class NearCells {
 public:
  // Squares have sides of `size` metres; those up to `reach` squares away from a point's are near.
  NearCells(double size, long long reach) : size_(size), reach_(reach) {}

  void add(const Eigen::Vector2d& p);
  bool contains(const Eigen::Vector2d& p) const { return near_.contains(cell_of(p)); }

 private:
  using Cell = std::pair<long long, long long>;
  Cell cell_of(const Eigen::Vector2d& p) const {
    return {std::llround(p.x() / size_), std::llround(p.y() / size_)};
  }

  double size_;
  long long reach_;
  std::set<Cell> middles_, near_;
};

// Makes a town of six by six junctions, about 100 m apart: bent streets, some junctions with three
// arms, every third street a wide one. It needs no map.
Streets make_town(std::uint64_t seed);

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
