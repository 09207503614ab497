// This file defines a reduced view of cameras and LiDAR for people who watch.
#pragma once

#include <cstdint>
#include <vector>

#include "msgs/sample.h"

namespace maploop {

// `stamp` is that of the picture, or of the scan if there is no picture.
struct Preview : Sample {
  // Holds where a feature was in the previous picture and where it is now; px of the picture.
  struct Track {
    float from_u = 0.0F, from_v = 0.0F;
    float u = 0.0F, v = 0.0F;

    void archive(auto& ar) { ar(from_u, from_v, u, v); }
  };
  struct Point {
    std::int16_t x = 0, y = 0, z = 0;  // cm, body

    void archive(auto& ar) { ar(x, y, z); }
  };

  int width = 0, height = 0;       // px; 0: no picture
  std::vector<std::uint8_t> jpeg;  // of the left camera
  std::vector<Track> tracks;
  Time scan_stamp{};          // of the points
  std::vector<Point> points;  // some points of a turn; empty without a scan

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), width, height, jpeg, tracks, scan_stamp, points);
  }
};

}  // namespace maploop
