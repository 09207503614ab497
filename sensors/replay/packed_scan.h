// This file stores a turn of a LiDAR in the form in which its scanner measures it, as one range for
// each laser and firing: a twelfth of the size of its points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "msgs/lidar_scan.h"

namespace maploop::sensors {

struct RangeImage {
  static constexpr double range_unit = 0.002;       // m, that of an HDL-64E
  static constexpr double reflectance_unit = 0.01;  // of 1
  static constexpr std::size_t max_lasers = 128, max_firings = 4096;

  std::vector<float> elevations;  // rad, of each laser
  std::size_t firings = 0;        // of each laser in a turn
  double first_azimuth = 0.0;     // rad, counter-clockwise from straight ahead, of the first firing
  double azimuth_step = 0.0;      // rad, from one firing to the next
  // Ordered by laser, then by firing, in the units above; a range of 0 means no return.
  std::vector<std::uint16_t> ranges;
  std::vector<std::uint8_t> reflectances;
};

// Converts the returns to points, ordered by laser; firings without a return are left out.
void points_of(const RangeImage& image, std::vector<LidarPoint>& points);

std::string pack_scan(const RangeImage& image);

// Returns the points of a packed scan; `image` only provides memory to reuse. Throws
// std::runtime_error whose text is the reason only: not a packed scan, cut, damaged.
void unpack_scan(const std::vector<char>& bytes, RangeImage& image,
                 std::vector<LidarPoint>& points);

}  // namespace maploop::sensors
