// Doubts about a map are written to GeoJSON, which editors of OpenStreetMap open, and read back.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/match/doubt_pool.h"

namespace maploop::match {

// Writes a line where the vehicle drove for each, with the properties kind, description,
// probability, times, drives, way, node_a, node_b, to_way, to_node_a, to_node_b, length_m, offset_m
// and offset_sigma_m; a wrong direction has `ways`, all of its link. Throws std::runtime_error
// naming the file.
void write_doubts(const std::filesystem::path& file, const std::vector<PooledDoubt>& doubts,
                  const mapmatch::RoadNetwork& network);

// Reads what map_corrections.h needs of the doubts that are at least so likely: kind, probability,
// ways, the first node of the way driven after, and track. A wrong direction of several ways is a
// doubt for each. Throws std::runtime_error naming the file and what is wrong.
std::vector<MapDoubt> read_doubts(const std::filesystem::path& file, double min_probability);

}  // namespace maploop::match
