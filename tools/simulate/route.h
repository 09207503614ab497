// Ways through streets, as a car may drive them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulate/streets.h"

namespace maploop::simulate {

// m/s, of all limits.
double fastest(const Streets& streets);

// The junction nearest to a place.
std::size_t nearest_junction(const Streets& streets, const Eigen::Vector2d& place);

// Where one can go on from for ever, in no wrong direction of a one-way street and without turning
// back.
class Directions {
 public:
  explicit Directions(const Streets& streets);

  const std::vector<DirectedStreet>& exits(std::size_t junction) const { return exits_[junction]; }
  bool is_through(DirectedStreet d) const { return through_[slot(d)]; }
  bool has_exit(std::size_t junction) const;
  // Whether `next`, which begins where `before` ends, is no turning back (by more than 150
  // degrees).
  bool follows(DirectedStreet before, DirectedStreet next) const;

 private:
  static std::size_t slot(DirectedStreet d) { return 2 * d.street + (d.forward ? 1U : 0U); }

  const Streets* streets_;
  std::vector<std::vector<DirectedStreet>> exits_;
  std::vector<bool> through_;
};

// A walk of at least `metres` which prefers streets where it has not been. Throws
// std::runtime_error where that cannot be done.
std::vector<DirectedStreet> make_route(const Streets& streets, std::size_t start, double metres,
                                       std::uint64_t seed);

// The shortest way by all junctions of `via` in their order, and on as above. Throws
// std::runtime_error naming by number (from 1) the two that no way joins.
std::vector<DirectedStreet> make_route(const Streets& streets, const std::vector<std::size_t>& via,
                                       double metres, std::uint64_t seed);

// What lies up to `reach` metres beside a route, and the route in it.
struct Corridor {
  Streets streets;
  std::vector<DirectedStreet> route;
};
Corridor corridor(const Streets& streets, const std::vector<DirectedStreet>& route, double reach);

}  // namespace maploop::simulate
