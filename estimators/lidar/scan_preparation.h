// A raw scan is converted here to surface points at one time.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "estimators/lidar/parameters.h"
#include "estimators/lidar/scan_view.h"
#include "estimators/lidar/surface_normals.h"
#include "estimators/lidar/surface_point.h"
#include "estimators/lidar/voxel_moments.h"

namespace maploop::lidar {

// Describes the body's motion, assumed constant during a scan.
struct Twist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, body
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      // rad/s, body

  // Returns the motion over `seconds`, T_before_after.
  Eigen::Isometry3d over(double seconds) const;
  static Twist of(const Eigen::Isometry3d& T_before_after, double seconds);
};

template <class Archive>
void archive(Archive& ar, Twist& twist) {
  ar(twist.velocity, twist.rate);
}

// Returns when the LiDAR pointed to azimuth atan2(y, x), as a share of the turn in [0, 1]. Seen
// from above it turns clockwise, from the rear (0) over the left (1/4), front (1/2) and right (3/4)
// to the rear (1). The error is at most 2e-5 of a turn (2 us).
float turn_fraction(float x, float y);

// Gives the time of each point of a scan, in seconds after `from`: its own, or that of its azimuth.
class PointTimes {
 public:
  // The points must outlive this.
  PointTimes(const ScanView& scan, Time from);
  float operator()(std::size_t i) const;

 private:
  ScanView scan_;
  float middle_, first_half_, second_half_;
};

// Returns the point with a correction added to its elevation and its range unchanged; `cosine` and
// `sine` are those of the correction.
Eigen::Vector3f with_elevation(const Eigen::Vector3f& point, float cosine, float sine);

// Crops by range, corrects the elevation, deskews by the time of each point, and takes one sample
// per voxel with the normal of its neighbourhood. The same points in any order give the same bits.
// Not thread-safe, since it keeps its buffers.
class ScanPreparation {
 public:
  ScanPreparation(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters);

  // Moves the points to their positions at `stamp`, the time of the pose that the registration will
  // find. `motion` is the vehicle's during the scan. Precondition: start < middle < end. Points
  // that are not finite are cropped.
  void prepare(const ScanView& scan, Time stamp, const Twist& motion, PreparedScan* prepared);

 private:
  Eigen::Isometry3f T_body_velo_;
  LidarParameters parameters_;
  VoxelMoments moments_;
};

}  // namespace maploop::lidar
