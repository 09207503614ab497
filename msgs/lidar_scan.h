// This file defines one turn of a spinning LiDAR.
#pragma once

#include <vector>

#include "msgs/sample.h"

namespace maploop {

struct LidarPoint {
  float x, y, z;      // m, in velo; raw: not corrected for the vehicle's motion
  float reflectance;  // 0..1
};

// `stamp` is the middle of the turn, when the LiDAR faces forward; buffers keep their capacity.
struct LidarScan : Sample {
  Time start{};
  Time end{};
  std::vector<LidarPoint> points;
};

template <class Archive>
void archive(Archive& ar, LidarPoint& p) {
  ar(p.x, p.y, p.z, p.reflectance);
}

template <class Archive>
void archive(Archive& ar, LidarScan& scan) {
  ar(static_cast<Sample&>(scan), scan.start, scan.end, scan.points);
}

}  // namespace maploop
