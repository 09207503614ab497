// This file describes where each laser of a Velodyne scanner points.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "sensors/velodyne/model.h"

namespace maploop::sensors {

// A return at range r, with the scanner turned to azimuth a (clockwise, 0: forward), is at
//   r' = r + range_correction,  h = r' cos_elevation + outwards,  a' = a - azimuth_correction
//   forward = h cos a' + sideways sin a',  right = h sin a' - sideways cos a'
//   up = r' sin_elevation + upwards
// (HDL-64E S2 user's manual, appendix E). Lengths are in m.
struct Laser {
  double cos_elevation = 1.0;
  double sin_elevation = 0.0;
  double cos_azimuth_correction = 1.0;
  double sin_azimuth_correction = 0.0;
  double range_correction = 0.0;
  double outwards = 0.0;
  double sideways = 0.0;
  double upwards = 0.0;
};

std::size_t laser_count(VelodyneModel model);

// Returns 64, 32 or 16 lasers, ordered by the number of the laser in the packet; for the HDL-64E
// those of the upper block come first. The values of the HDL-32E and VLP-16 are from their manuals
// (VLP-16: revision E, with its vertical offsets). Throws std::invalid_argument for the HDL-64E,
// because each unit has its own.
std::vector<Laser> factory_lasers(VelodyneModel model);

// Reads Velodyne's own calibration file of a scanner (db.xml; angles in degrees, lengths in cm).
// Throws std::runtime_error that names the file and states what is wrong: missing, not such a file,
// not exactly the lasers of the model, or a value that no scanner has.
std::vector<Laser> read_velodyne_calibration(const std::filesystem::path& file,
                                             VelodyneModel model);

}  // namespace maploop::sensors
