// A turn of a LiDAR as its scanner makes it, a range each laser and firing: a twelfth of the size
// of its points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "msgs/lidar_scan.h"

namespace maploop::sensors {

struct RangeImage {
  static constexpr double range_unit = 0.002;       // m, an HDL-64E's
  static constexpr double reflectance_unit = 0.01;  // of 1
  static constexpr std::size_t most_lasers = 128, most_firings = 4096;

  std::vector<float> elevations;  // rad, of each laser
  std::size_t firings = 0;        // of each laser in a turn
  double first_azimuth = 0.0;     // rad, counter-clockwise from ahead, of the first firing
  double azimuth_step = 0.0;      // rad, from one firing to the next
  // Laser by laser, firing by firing, in units; a range of 0: nothing came back.
  std::vector<std::uint16_t> ranges;
  std::vector<std::uint8_t> reflectances;
};

// Laser by laser, those that came back.
void points_of(const RangeImage& image, std::vector<LidarPoint>& points);

std::string pack_scan(const RangeImage& image);

// The points of a packed scan; `image` is used to reuse its memory. Throws std::runtime_error with
// the reason alone: no packed scan, cut, damaged.
void unpack_scan(const std::vector<char>& bytes, RangeImage& image,
                 std::vector<LidarPoint>& points);

}  // namespace maploop::sensors
