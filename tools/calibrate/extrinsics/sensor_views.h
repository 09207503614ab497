// What cameras and LiDAR saw of the same moments.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "estimators/lidar/surface_point.h"
#include "estimators/stereo/triangulate.h"
#include "msgs/image.h"
#include "tools/calibrate/extrinsics/rotation_stream.h"

namespace maploop::extrinsics {

// One pair of images.
struct CameraView {
  Time stamp{};
  std::vector<stereo::ImagePoint> points;  // features of the left image, and their disparities
  GreyImage edges;                         // of the left image (image_edges.h)
};

// One scan, in the scanner's axes at its stamp.
struct LidarView {
  lidar::PreparedScan surfaces;
  std::vector<Eigen::Vector3f> edges;  // m (depth_edges.h)
};

// An image, and the scan that was taken at about the same time.
struct ViewPair {
  const CameraView* image = nullptr;
  const LidarView* scan = nullptr;
  Eigen::Isometry3d T_scan_image = Eigen::Isometry3d::Identity();  // the LiDAR's motion between
  double time = 0.0;                                               // s, since the first image
};

// Returns the pairs, in the order of time, that are at most 0.15 s apart by the LiDAR's clock, from
// which the images' stamps differ by `delay` (s). The views must outlive them.
std::vector<ViewPair> pair_views(std::span<const CameraView> images,
                                 std::span<const LidarView> scans,
                                 std::span<const SensorMotion> lidar_motions, double delay);

}  // namespace maploop::extrinsics
