// A doubt pool joins what several drives contradict of one map.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "mapmatch/road_network.h"
#include "msgs/map_doubt.h"

namespace maploop::match {

// Holds a contradiction that was found once or more often.
struct PooledDoubt {
  // The likeliest of them; the probability, offset and its sigma are those of all together.
  MapDoubt doubt;
  std::size_t times = 0;         // so often found ...
  std::set<std::string> drives;  // ... in these drives
};

// What two drives contradict is the same if it concerns the same link, turn, or, of a road that is
// missing, the same ground within 20 m. Their errors are taken to be independent.
class DoubtPool {
 public:
  // The network must outlive this object.
  explicit DoubtPool(const mapmatch::RoadNetwork& network) : network_(network) {}

  void add(const MapDoubt& doubt, const std::string& drive);
  // Returns those that are likelier than this, the likeliest first.
  std::vector<PooledDoubt> likelier_than(double probability) const;

 private:
  // Sums over the doubts that are joined in one.
  struct Sums {
    PooledDoubt pooled;
    double all_wrong = 1.0;             // P that none of them is right
    double weight = 0.0, offset = 0.0;  // 1/m^2, 1/m: of a shifted road, to the right of the link
  };

  bool same(const MapDoubt& a, const MapDoubt& b) const;
  PooledDoubt total(const Sums& sums) const;

  const mapmatch::RoadNetwork& network_;
  std::vector<Sums> all_;
};

}  // namespace maploop::match
