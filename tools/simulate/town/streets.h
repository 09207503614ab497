// The true streets of a simulated drive; the map may differ from them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
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

// Computes `along`.
void measure(Street& street);

// Makes a town of six by six junctions, about 100 m apart: bent streets, some junctions with three
// arms, every third street a wide one. It needs no map.
Streets make_town(std::uint64_t seed);

}  // namespace maploop::simulate
