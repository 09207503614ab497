// The links really driven, frame by frame (labels of recorded drives).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>

namespace maploop::match {

struct Label {
  std::int64_t way_id = 0, node_a = 0, node_b = 0;  // an OSM segment, as driven
  bool certain = false;  // conf = 1: not near a junction, no other road that it might be
};

// By the number of the track's row. CSV with the columns frame, way_id, node_a, node_b and conf;
// plain or .gz. Throws std::runtime_error naming file and line.
std::map<std::size_t, Label> read_labels(const std::filesystem::path& file);

}  // namespace maploop::match
