// What cameras and LiDAR see, made small for people who look on.
#pragma once

#include <cstdint>
#include <vector>

#include "msgs/sample.h"

namespace maploop {

// `stamp` is the picture's, or the scan's where there is no picture.
struct Preview : Sample {
  // Where a feature was in the picture before and where it is now; px of the picture.
  struct Track {
    float from_u = 0.0F, from_v = 0.0F;
    float u = 0.0F, v = 0.0F;
  };
  struct Point {
    std::int16_t x = 0, y = 0, z = 0;  // cm, body
  };

  int width = 0, height = 0;       // px; 0: no picture
  std::vector<std::uint8_t> jpeg;  // of the left camera
  std::vector<Track> tracks;
  Time scan_stamp{};          // of the points
  std::vector<Point> points;  // some of a turn's; none: no scan
};

}  // namespace maploop
