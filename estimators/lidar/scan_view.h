// This file defines a view of the points of a scan that the caller keeps.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "msgs/lidar_scan.h"

namespace maploop::lidar {

// Refers to points, which must outlive the view. A point is x, y, z (m, velo) at the beginning of
// `stride` floats. Stamps are those of LidarScan.
struct ScanView : Sample {
  ScanView(const LidarScan& scan)
      : Sample(scan),
        start(scan.start),
        end(scan.end),
        first(reinterpret_cast<const float*>(scan.points.data())),
        count(scan.points.size()),
        stride(sizeof(LidarPoint) / sizeof(float)),
        times(scan.times.empty() ? nullptr : scan.times.data()) {}
  ScanView(const Sample& sample, Time begins, Time ends)
      : Sample(sample), start(begins), end(ends) {}

  Eigen::Vector3f operator[](std::size_t i) const {
    const float* point = first + i * stride;
    return {point[0], point[1], point[2]};
  }

  Time start{};
  Time end{};
  const float* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 4;        // floats, at least 3
  const float* times = nullptr;  // of each point, in s after the stamp; nullptr: by azimuth
};

inline std::optional<ScanView> view_of(const LidarScan* scan) {
  return scan != nullptr ? std::optional<ScanView>(*scan) : std::nullopt;
}

}  // namespace maploop::lidar
