// The visual-LiDAR odometer computes odometry from scans and the visual motions that seed them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "estimators/lidar/gicp.h"
#include "estimators/lidar/local_map.h"
#include "estimators/lidar/parameters.h"
#include "estimators/lidar/scan_preparation.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::lidar {

// Holds the motions that one step results in.
struct OdometerResult {
  LidarMotion lidar;        // from the scan, if there is one
  RelativeMotion odometry;  // LiDAR if that is ok, else visual
};

// Registers a scan with the map in place of Gicp::align(), with the same arguments and results.
using Registration = std::function<Alignment(const LocalMap& map, const PreparedScan& scan,
                                             const Eigen::Isometry3d& seed, bool known)>;

// The visual motion deskews the scan and seeds its registration with the recently seen surfaces. If
// the visual motion is refused, the last motion replaces it.
//
// Not thread-safe (but see ForEachChunk). The same input gives the same bits.
class LidarOdometry {
 public:
  // Throws std::invalid_argument, which names the value, if a parameter is not valid. Without
  // `for_each_chunk`, process() runs all chunks on its own thread. With a `registration`, another
  // method than Gicp is compared with it.
  LidarOdometry(const Eigen::Isometry3d& T_body_velo, const LidarParameters& parameters,
                ForEachChunk for_each_chunk = nullptr, Registration registration = nullptr);

  // Processes one step with a scan, with the visual motion of the image pair taken during that
  // scan, or with both. The resulting pose is at the visual motion's stamp, or at the scan's if
  // there is no visual motion, or if it is refused before any motion is known. Each motion begins
  // where the previous step ended. If the status of `lidar` is not ok, its pose and covariance are
  // identity and zero. Statuses:
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
  // The same for points that the caller keeps.
  OdometerResult process(const std::optional<ScanView>& scan, const RelativeMotion* visual);

  // Returns the last prepared scan, in the body frame at its `stamp`; for displays.
  const PreparedScan& prepared() const { return prepared_; }
  // Returns the map, in the body frame of the first step.
  const LocalMap& local_map() const { return map_; }
  // Returns the pose of the body at the last step in the body frame of the first.
  Eigen::Isometry3d pose() const { return T_map_body_; }

  // Archives the state after all steps so far, most of which is the map (msgs/archive.h). Loading
  // throws ArchiveError, and changes nothing, if the archive is broken or of another mounting,
  // other parameters or another version.
  std::size_t largest_archive() const { return map_.largest_archive() + 4096; }  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  struct Prediction {
    Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
    bool visual = false;
    bool known = false;  // false: the motion is unknown
  };

  template <class Archive, class Odometry>
  static void describe(Archive& ar, Odometry& odometry);
  bool tells_a_pose(const RelativeMotion& visual) const;
  bool after_gap(Time stamp) const;
  void begin(const Sample& sample, LidarMotion* motion) const;
  bool in_order(const std::optional<ScanView>& scan, Time stamp);
  bool too_late(const ScanView& scan) const;
  void restart();
  Prediction predict(Time stamp, const RelativeMotion* visual);
  void register_scan(const ScanView& scan, const Prediction& prediction, LidarMotion* motion);
  OdometryStatus judge(const Eigen::Isometry3d& T_from_to, const Prediction& prediction,
                       const LidarMotion& motion) const;
  Matrix6d covariance(const Alignment& alignment) const;
  void advance(const Eigen::Isometry3d& T_from_to, const OdometerResult& result);
  void learn(const ScanView& scan, OdometryStatus status);

  Eigen::Isometry3d T_body_velo_;
  LidarParameters parameters_;
  ForEachChunk for_each_chunk_;
  ScanPreparation preparation_;
  LocalMap map_;
  Gicp gicp_;
  Registration registration_;  // in place of gicp_, unless empty

  bool started_ = false;
  Time stamp_{};          // of the last step
  Time aligned_stamp_{};  // of the last step whose scan was used
  Eigen::Isometry3d T_map_body_ = Eigen::Isometry3d::Identity();  // at stamp_
  std::optional<Twist> twist_;                                    // the last motion
  // This is the covariance of the visual motions since the last used scan, in body axes at stamp_.
  // It is empty after a refused one.
  std::optional<Matrix6d> seed_covariance_;
  bool map_is_sharp_ = false;
  int refused_in_a_row_ = 0;
  int stale_ = 0;

  PreparedScan prepared_;  // buffer, kept to reuse its memory
};

}  // namespace maploop::lidar
