// Odometry from scans and from the visual motion that seeds them: the visual-LiDAR odometer.
#pragma once

#include <cstddef>
#include <memory>

#include "estimators/lidar/gicp.h"
#include "estimators/lidar/parameters.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::lidar {

struct OdometerResult {
  LidarMotion lidar;        // what the scan says, where there is one
  RelativeMotion odometry;  // the best of both: LiDAR where it is ok, else visual
};

// The visual motion deskews the scan and seeds its registration with the surfaces seen lately.
// Where it is refused, the last motion takes its place.
//
// Not thread-safe (but see ForEachChunk); the same input gives the same bits.
class LidarOdometry {
 public:
  // Throws std::invalid_argument naming the value where a parameter cannot be used.
  LidarOdometry(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters,
                ForEachChunk for_each_chunk = nullptr);
  ~LidarOdometry();
  LidarOdometry(LidarOdometry&&) noexcept;
  LidarOdometry& operator=(LidarOdometry&&) noexcept;

  // One step of time, with what there is of it: a scan, the visual motion of the image pair taken
  // during that scan, or both. The pose found is that at the visual motion's stamp; without one, at
  // the scan's. Each motion begins where the step before ended. Statuses of `lidar`, whose pose and
  // covariance are identity and zero where it is not ok:
  //   first_frame       no scan yet, or the last step is older than max_gap
  //   too_few_features  fewer than min_points surface points: empty, tiny, blocked
  //   too_few_inliers   too little of the scan is on the map
  //   not_converged     the registration did not settle
  //   implausible       beyond max_speed or max_yaw_rate
  //   disagreement      too far from the visual motion
  //   bad_input         no scan; stamps not in order, or not after the last step's; visual motion
  //                     not from within the scan's turn; a scan alone, when there was a step within
  //                     its turn already
  OdometerResult process(const LidarScan* scan, const RelativeMotion* visual);

  // Of the last scan, in the body frame at the last step; for displays.
  const PreparedScan& prepared() const;
  // Body at the last step in the body frame of the first.
  Eigen::Isometry3d pose() const;

  // msgs/archive.h: what the steps so far have left behind, most of it the map. Loading throws
  // ArchiveError, and changes nothing, where the archive is of another mounting, other parameters
  // or another version, or broken.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::lidar
