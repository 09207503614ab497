// This header converts scans to and from clouds of PCL. It includes nothing of PCL, so that only
// its users need PCL: include <pcl/point_cloud.h> and <pcl/point_types.h> beside it.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

#include "msgs/lidar_scan.h"

namespace maploop::sensors {

// This is a pcl::PointCloud of pcl::PointXYZ, pcl::PointXYZI, or any other points with float
// members x, y, z and perhaps intensity.
template <class Cloud>
concept PclCloud = requires(Cloud cloud, typename Cloud::PointType point) {
  cloud.header.stamp;
  cloud.push_back(point);
  point.x + point.y + point.z;
};

// Returns the points in m in the frame `velo`, not corrected for the vehicle's motion, with the
// reflectance 0..1 as intensity. The header has the scan's stamp in us since 1970 and its sequence.
template <PclCloud Cloud>
Cloud to_pcl(const LidarScan& scan) {
  Cloud cloud;
  cloud.header.frame_id = "velo";
  cloud.header.stamp = static_cast<std::uint64_t>(to_nanoseconds(scan.stamp) / 1000);
  cloud.header.seq = static_cast<std::uint32_t>(scan.sequence);
  cloud.reserve(scan.points.size());
  for (const LidarPoint& p : scan.points) {
    typename Cloud::PointType point;
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    if constexpr (requires { point.intensity; }) point.intensity = p.reflectance;
    cloud.push_back(point);
  }
  return cloud;
}

// Fills `scan`, whose buffers are reused, without the points that are not finite. A cloud does not
// state how long its turn took: start and end are a nanosecond before and after the stamp, so that
// an estimator does not correct the points for the vehicle's motion; set them where they are known.
template <PclCloud Cloud>
void from_pcl(const Cloud& cloud, LidarScan& scan) {
  scan.stamp = scan.available =
      Time(std::chrono::microseconds(static_cast<std::int64_t>(cloud.header.stamp)));
  scan.start = scan.stamp - Duration(1);
  scan.end = scan.stamp + Duration(1);
  scan.sequence = cloud.header.seq;
  scan.points.clear();
  for (const auto& point : cloud) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
    float reflectance = 0.0F;
    if constexpr (requires { point.intensity; }) reflectance = point.intensity;
    scan.points.push_back({point.x, point.y, point.z, reflectance});
  }
}

}  // namespace maploop::sensors
