// Collects the surfaces of all scans in one frame.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <unordered_set>
#include <vector>

#include "estimators/lidar/scan_preparation.h"

namespace maploop::odometry {

// Scans are deskewed and sampled more finely than odometry needs; the first point in each cell is
// kept.
class PointCloud {
 public:
  PointCloud(const Eigen::Isometry3d& T_body_velo, const lidar::LidarParameters& parameters);

  // `T_first_body` is the pose at `stamp`, `motion` that of the body while the scan was taken.
  void add(const LidarScan& scan, Time stamp, const lidar::Twist& motion,
           const Eigen::Isometry3d& T_first_body);

  std::size_t size() const { return points_.size(); }
  const std::vector<lidar::SurfacePoint>& points() const { return points_; }  // first body frame

  // Writes a binary .ply or .pcd: x y z (m) and the normal. Throws std::runtime_error naming the
  // file if it has another extension or cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  lidar::ScanPreparation preparation_;
  lidar::PreparedScan prepared_;
  std::unordered_set<std::uint64_t> cells_;
  std::vector<lidar::SurfacePoint> points_;
};

// Throws std::runtime_error for an extension that write() does not support.
void check_cloud_name(const std::filesystem::path& file);

}  // namespace maploop::odometry
