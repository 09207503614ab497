// The visual-LiDAR odometer computes odometry from scans and the visual motions that seed them.
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
  LidarMotion lidar;        // from the scan, if there is one
  RelativeMotion odometry;  // LiDAR if that is ok, else visual
};

// The visual motion deskews the scan and seeds its registration with the recently seen surfaces. If
// the visual motion is refused, the last motion replaces it.
//
// Not thread-safe (but see ForEachChunk). The same input gives the same bits.
class LidarOdometry {
 public:
  // Throws std::invalid_argument, which names the value, if a parameter is not valid. Without
  // `for_each_chunk`, process() runs all chunks on its own thread.
  LidarOdometry(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters,
                ForEachChunk for_each_chunk = nullptr);
  ~LidarOdometry();
  LidarOdometry(LidarOdometry&&) noexcept;
  LidarOdometry& operator=(LidarOdometry&&) noexcept;

  // Processes one step with a scan, with the visual motion of the image pair taken during that
  // scan, or with both. The resulting pose is at the visual motion's stamp, or at the scan's if
  // there is no visual motion. Each motion begins where the previous step ended. If the status of
  // `lidar` is not ok, its pose and covariance are identity and zero. Statuses:
  //   first_frame       no scan yet, or the last step is older than max_gap
  //   too_few_features  fewer than min_points surface points: empty, tiny or blocked scan
  //   too_few_inliers   too little of the scan is on the map
  //   not_converged     the registration did not converge
  //   implausible       beyond max_speed or max_yaw_rate
  //   disagreement      too far from the visual motion
  //   bad_input         no scan; stamps not in order, or not after the last step's; visual motion
  //                     outside the scan's turn; a scan alone, if a step within its turn was
  //                     already processed
  OdometerResult process(const LidarScan* scan, const RelativeMotion* visual);

  // Returns the last prepared scan, in the body frame at its `stamp`; for displays.
  const PreparedScan& prepared() const;
  // Returns the pose of the body at the last step in the body frame of the first.
  Eigen::Isometry3d pose() const;

  // Archives the state after all steps so far, most of which is the map (msgs/archive.h). Loading
  // throws ArchiveError, and changes nothing, if the archive is broken or of another mounting,
  // other parameters or another version.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::lidar
