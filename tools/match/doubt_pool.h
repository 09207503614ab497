// A doubt pool joins what several drives contradict of one map.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "mapmatch/road_network.h"
#include "msgs/map_doubt.h"

namespace maploop::match {

// Holds a contradiction that was found once or more often.
struct PooledDoubt {
  // The likeliest of them, or the longest missing road; the probability, offset and its sigma are
  // those of all together.
  MapDoubt doubt;
  std::size_t times = 0;         // how often it was found
  std::set<std::string> drives;  // which drives found it
};

// Two doubts are joined if they are about the same link or turn. Two missing roads are joined if
// they are on the same ground within 20 m. The errors of two drives are taken to be independent,
// those of one drive to be the same.
class DoubtPool {
 public:
  // The network must outlive this object.
  explicit DoubtPool(const mapmatch::RoadNetwork& network) : network_(network) {}

  // Leaves out what is unlikelier than not: many drives of a right map would otherwise refute it.
  // Only offsets count in any case, as they may be of either side.
  void add(const MapDoubt& doubt, const std::string& drive);
  // Returns those that are likelier than this, the likeliest first.
  std::vector<PooledDoubt> likelier_than(double probability) const;

 private:
  // The doubts that are joined in one.
  struct Group {
    PooledDoubt pooled;
    // This holds the likeliest doubt of each drive, or the longest one of a shifted road.
    std::map<std::string, MapDoubt> of_drive;
  };

  bool same(const MapDoubt& a, const MapDoubt& b) const;
  PooledDoubt total(const Group& group) const;

  const mapmatch::RoadNetwork& network_;
  std::vector<Group> all_;
};

}  // namespace maploop::match
