// Writes the map that the matcher gets: the true streets with the errors that a mapper might make.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

struct MapErrors {
  double shift = 2.0;          // m rms, smooth displacement of the streets
  double correlation = 300.0;  // m, distance over which the displacement changes
  double wrong = 0.05;         // share of streets missing, one-way reversed, or extra
};

// Writes the streets' centrelines as an OpenStreetMap file.
void write_road_map(const std::filesystem::path& file, const Streets& streets,
                    const LocalFrame& frame, std::uint64_t seed, const MapErrors& errors = {});

// Writes the segments of that map that were driven at each frame (times in s) as labels.csv: frame,
// way, both nodes, and a confidence, which is 0 near a junction and otherwise 1.
void write_driven_links(const std::filesystem::path& file, const Streets& streets,
                        const VehicleMotion& motion, const std::vector<double>& times);

}  // namespace maploop::simulate
