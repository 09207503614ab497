// From a raw scan to surface points at one moment.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "estimators/lidar/parameters.h"
#include "estimators/lidar/surface_normals.h"
#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_moments.h"
#include "msgs/lidar_scan.h"

namespace maploop::lidar {

// Motion of the body, constant while a scan lasts.
struct Twist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, body
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      // rad/s, body

  // The motion that takes `seconds`: T_before_after.
  Eigen::Isometry3d over(double seconds) const;
  static Twist of(const Eigen::Isometry3d& T_before_after, double seconds);
};

template <class Archive>
void archive(Archive& ar, Twist& twist) {
  ar(twist.velocity, twist.rate);
}

// When the LiDAR pointed to azimuth atan2(y, x), as a share of the turn, in [0, 1]: it turns
// clockwise seen from above, from the rear (0) over the left (1/4), front (1/2) and right (3/4) to
// the rear (1). To 2e-5 of a turn (2 us).
float turn_fraction(float x, float y);

// The same point with `correction` (rad) added to its elevation, its range kept.
Eigen::Vector3f with_elevation(const Eigen::Vector3f& point, float cosine, float sine);

// Crop by range, correction of the elevation, time of each point from its azimuth, deskew, one
// sample a voxel with the normal of its neighbourhood. The same points in any order give the same
// bits. Not thread-safe: it keeps its buffers.
class ScanPreparation {
 public:
  ScanPreparation(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters);

  // `stamp` is the moment at which the points are to stand: that of the pose which the registration
  // will find. `motion` is the vehicle's while the scan was taken. Precondition: start < middle <
  // end. Points that are not finite are cropped.
  void prepare(const LidarScan& scan, Time stamp, const Twist& motion, PreparedScan* prepared);

 private:
  Eigen::Isometry3f T_body_velo_;
  LidarParameters parameters_;
  VoxelMoments moments_;
};

}  // namespace maploop::lidar
