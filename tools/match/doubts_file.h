// Doubts about a map are written to GeoJSON, which editors of OpenStreetMap open, and read back.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/match/doubt_pool.h"

namespace maploop::match {

// Writes a line where the vehicle drove for each, with the properties kind, description,
// probability, times, drives, way, node_a, node_b, to_way, to_node_a, to_node_b, length_m, offset_m
// and offset_sigma_m. Throws std::runtime_error naming the file.
void write_doubts(const std::filesystem::path& file, const std::vector<PooledDoubt>& doubts,
                  const mapmatch::RoadNetwork& network);

// Reads the doubts that are at least so likely. Their links and stamps are not in the file. Throws
// std::runtime_error naming the file and what is wrong.
std::vector<MapDoubt> read_doubts(const std::filesystem::path& file, double min_probability);

}  // namespace maploop::match
