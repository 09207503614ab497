// This file defines one scan of a LiDAR: a turn of a spinning one, or what another one saw
// meanwhile.
#pragma once

#include <vector>

#include "msgs/sample.h"

namespace maploop {

// This is one return of a laser pulse.
struct LidarPoint {
  float x, y, z;      // m, in velo; raw: not corrected for the vehicle's motion
  float reflectance;  // 0..1

  void archive(auto& ar) { ar(x, y, z, reflectance); }
};

// `stamp` is the middle of the scan; of a turn, when the LiDAR faces forward. Buffers keep their
// capacity.
struct LidarScan : Sample {
  Time start{};                    // when the scan began
  Time end{};                      // when it ended
  std::vector<LidarPoint> points;  // all of the scan
  // When each point was measured, in s after `stamp`. Empty: the LiDAR turned clockwise, seen from
  // above, from the rear at `start` to the rear at `end`, so that azimuths are times.
  std::vector<float> times;

  void archive(auto& ar) { ar(static_cast<Sample&>(*this), start, end, points, times); }
};

}  // namespace maploop
