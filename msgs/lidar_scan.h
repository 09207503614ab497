// This file defines one turn of a spinning LiDAR.
#pragma once

#include <vector>

#include "msgs/sample.h"

namespace maploop {

struct LidarPoint {
  float x, y, z;      // m, in velo; raw: not corrected for the vehicle's motion
  float reflectance;  // 0..1

  void archive(auto& ar) { ar(x, y, z, reflectance); }
};

// `stamp` is the middle of the turn, when the LiDAR faces forward; buffers keep their capacity.
struct LidarScan : Sample {
  Time start{};
  Time end{};
  std::vector<LidarPoint> points;

  void archive(auto& ar) { ar(static_cast<Sample&>(*this), start, end, points); }
};

}  // namespace maploop
