// The streets that a drive is simulated on: what is really there, not what the map says of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace maploop::simulate {

struct Street {
  std::size_t from = 0, to = 0;             // junctions
  std::vector<Eigen::Vector2d> centreline;  // m, enu; from the one junction to the other, 2 m apart
  std::vector<double> along;                // m from its begin, of each point
  double half_width = 3.5;                  // m
  double speed_limit = 13.9;                // m/s
  bool forward = true, backward = true;     // where it may be driven

  double length() const { return along.back(); }
  // m to the right of the centreline, where a car drives.
  double lane() const { return 0.5 * half_width; }
};

// A street with its direction.
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
  // As driven.
  std::vector<Eigen::Vector2d> centreline(DirectedStreet d) const;
  // Those that leave each junction, as they may be driven.
  std::vector<std::vector<DirectedStreet>> exits() const;
};

// Fills in `along`.
void measure(Street& street);

// A town of six by six junctions, about 100 m apart: bent streets, some junctions with three arms,
// every third street a wide one. Needs no map.
Streets make_town(std::uint64_t seed);

}  // namespace maploop::simulate
