// Finds routes through streets that a car may drive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulate/town/streets.h"

namespace maploop::simulate {

// Returns the highest speed limit, m/s.
double fastest(const Streets& streets);

// Returns the index of the junction nearest to a place (m, enu).
std::size_t nearest_junction(const Streets& streets, const Eigen::Vector2d& place);

// Tells which directed streets can be continued forever, without driving a one-way street in the
// wrong direction and without turning back.
class Directions {
 public:
  explicit Directions(const Streets& streets);

  const std::vector<DirectedStreet>& exits(std::size_t junction) const { return exits_[junction]; }
  bool is_through(DirectedStreet d) const { return through_[slot_of(d)]; }
  bool has_exit(std::size_t junction) const;
  // Whether driving from the end of `before` into `next` is not turning back (by more than 150
  // degrees).
  bool follows(DirectedStreet before, DirectedStreet next) const;

 private:
  const Streets* streets_;
  std::vector<std::vector<DirectedStreet>> exits_;
  std::vector<bool> through_;
};

// Makes a random route of at least `metres` which prefers streets not yet driven. Throws
// std::runtime_error if it reaches a dead end.
std::vector<DirectedStreet> make_route(const Streets& streets, std::size_t start, double metres,
                                       std::uint64_t seed);

// Makes the shortest route through all junctions of `via` in their order, and continues it randomly
// as above. Throws std::runtime_error naming by number (from 1) two consecutive junctions that no
// route joins.
std::vector<DirectedStreet> make_route(const Streets& streets, const std::vector<std::size_t>& via,
                                       double metres, std::uint64_t seed);

// The streets up to `reach` metres beside a route, and the route in terms of them.
struct Corridor {
  Streets streets;
  std::vector<DirectedStreet> route;
};
Corridor corridor(const Streets& streets, const std::vector<DirectedStreet>& route, double reach);

}  // namespace maploop::simulate
