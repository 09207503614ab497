#include "mapmatch/dead_ends.h"

#include <algorithm>
#include <span>

#include "mapmatch/road_network.h"
#include "msgs/input_limits.h"

namespace maploop::mapmatch {
namespace {

// Finds the ways whose reversal leaves fewer junctions that traffic cannot leave or cannot reach.
class DeadEnds {
 public:
  explicit DeadEnds(const RoadNetwork& network)
      : network_(network), links_(network.data().roads.size()), gain_(links_.size()) {
    for (std::uint32_t link = 0; link < network.size(); ++link)
      if (network.link(link).one_way()) links_[way_of(link)].push_back(link);
    for (std::uint32_t way = 0; way < links_.size(); ++way) gain_[way] = gain(links_[way]);
  }

  std::vector<std::uint32_t> links() const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t junction = 0; junction < network_.data().junctions.size(); ++junction) {
      if (!closed(junction, {})) continue;
      std::ptrdiff_t most = 1;
      for (const DirectedLink exit : network_.exits(junction))
        most = std::max(most, gain_[way_of(exit.link)]);
      for (const DirectedLink exit : network_.exits(junction)) {
        if (gain_[way_of(exit.link)] < most) continue;
        const auto& links = links_[way_of(exit.link)];
        found.insert(found.end(), links.begin(), links.end());
      }
    }
    return found;
  }

 private:
  std::uint32_t way_of(std::uint32_t link) const {
    return network_.vertex(network_.link(link).first_vertex).road;
  }

  std::ptrdiff_t gain(const std::vector<std::uint32_t>& links) const {
    std::vector<std::uint32_t> junctions;
    for (const std::uint32_t link : links) {
      junctions.push_back(network_.link(link).start_junction);
      junctions.push_back(network_.link(link).end_junction);
    }
    std::sort(junctions.begin(), junctions.end());
    junctions.erase(std::unique(junctions.begin(), junctions.end()), junctions.end());
    std::ptrdiff_t gain = 0;
    for (const std::uint32_t junction : junctions)
      gain += int{closed(junction, {})} - int{closed(junction, links)};
    return gain;
  }

  // Returns whether traffic cannot leave or cannot reach a junction where roads meet, with some
  // links (sorted) reversed. A junction of more roads than any real one has is not judged.
  bool closed(std::uint32_t junction, std::span<const std::uint32_t> reversed) const {
    const auto exits = network_.exits(junction);
    if (exits.size() < 2 || exits.size() > input_limits::roads_at_node) return false;
    bool out = false, in = false;
    for (const DirectedLink exit : exits) {
      const bool turned = std::binary_search(reversed.begin(), reversed.end(), exit.link);
      out |= network_.allowed(turned ? exit.reversed() : exit);
      in |= network_.allowed(turned ? exit : exit.reversed());
    }
    return !(in && out);
  }

  const RoadNetwork& network_;
  std::vector<std::vector<std::uint32_t>> links_;  // one-way, by way
  std::vector<std::ptrdiff_t> gain_;               // by way
};

}  // namespace

std::vector<std::uint32_t> dead_ended_links(const RoadNetwork& network) {
  return DeadEnds(network).links();
}

}  // namespace maploop::mapmatch
