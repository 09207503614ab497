// Reads the links really driven, frame by frame (labels of recorded drives).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "mapmatch/road_network.h"

namespace maploop::match {

struct Label {
  std::int64_t way_id = 0, node_a = 0, node_b = 0;  // an OSM segment, in driving direction
  bool certain = false;  // conf = 1: not near a junction, and no other road could be meant
  std::optional<mapmatch::DirectedLink> link{};  // of a network, if it was looked up
};

// Returns labels by the row number of the track. The file is CSV with the columns frame, way_id,
// node_a, node_b and conf, plain or .gz. Throws std::runtime_error naming file and line.
std::map<std::size_t, Label> read_labels(const std::filesystem::path& file);

// Finds the links of a network by their segments.
class SegmentLinks {
 public:
  explicit SegmentLinks(const mapmatch::RoadNetwork& network);

  // Returns the link that a segment is part of, in the direction from a to b, or nothing if the
  // network has no such segment.
  std::optional<mapmatch::DirectedLink> find(std::int64_t node_a, std::int64_t node_b) const;
  void look_up(std::map<std::size_t, Label>& labels) const;

 private:
  std::map<std::pair<std::int64_t, std::int64_t>, mapmatch::DirectedLink> links_;
};

}  // namespace maploop::match
