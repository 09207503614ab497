// Collects the surfaces of all scans in one frame.
#pragma once

#include <Eigen/Geometry>
#include <unordered_set>
#include <vector>

#include "estimators/lidar/scan_preparation.h"
#include "sensors/cloud/cloud_file.h"

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

 private:
  lidar::ScanPreparation preparation_;
  lidar::PreparedScan prepared_;
  std::unordered_set<std::uint64_t> cells_;
  std::vector<lidar::SurfacePoint> points_;
};

// Returns x y z (m) and the normal of each point, which is zero where its points do not determine
// it.
sensors::CloudTable table_of(const std::vector<lidar::SurfacePoint>& points);

// Returns x y z (m) and intensity of a scan's raw points, and their time (s, from the scan's stamp)
// if it is known: from `times`, or else from their azimuths, if the scan has a start and an end.
sensors::CloudTable table_of(const LidarScan& scan);

}  // namespace maploop::odometry
