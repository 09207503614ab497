// The map that the matcher gets: not what is there, but what a mapper might have drawn.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/vehicle_motion.h"

namespace maploop::simulate {

struct MapErrors {
  double shift = 2.0;          // m rms, how far streets are off, smoothly
  double correlation = 300.0;  // m, over which that changes
  double wrong = 0.05;         // share of streets that are missing, one way the wrong way, or extra
};

// An OpenStreetMap file of the streets' centrelines.
void write_road_map(const std::filesystem::path& file, const Streets& streets,
                    const LocalFrame& frame, std::uint64_t seed, const MapErrors& errors = {});

// The segments of that map that were driven, frame by frame (times in s), as labels.csv: frame,
// way, both nodes, and 0 near a junction.
void write_driven_links(const std::filesystem::path& file, const Streets& streets,
                        const VehicleMotion& motion, const std::vector<double>& times);

}  // namespace maploop::simulate
