// Visual odometry from rectified stereo pairs, one motion a pair.
#pragma once

#include <cstddef>
#include <memory>

#include "estimators/stereo/parameters.h"
#include "msgs/calibration.h"
#include "msgs/image.h"
#include "msgs/odometry.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::stereo {

// Corners spread by buckets are followed around a circle of four images, triangulated, resected
// (P3P in RANSAC) and adjusted (method.md 2.1; after Kitt, Geiger and Lategahn, "Visual Odometry
// based on Stereo Image Sequences with RANSAC-based Outlier Rejection Scheme", IV 2010).
//
// Not thread-safe; the same pairs give the same bits. About 13 MB of buffers for images of 0.5 Mpx.
class StereoOdometry {
 public:
  // Throws std::invalid_argument naming the value where the calibration or a parameter cannot be
  // used.
  StereoOdometry(const StereoCalibration& calibration, const StereoParameters& parameters);
  ~StereoOdometry();
  StereoOdometry(StereoOdometry&&) noexcept;
  StereoOdometry& operator=(StereoOdometry&&) noexcept;

  // Motion of the body from the newest usable pair before this one (`from`) to this one. stamp,
  // available and sequence are the pair's. Never throws on what a camera may deliver; a refusal
  // carries its reason in `status`, and then pose and covariance are identity and zero:
  //   first_frame: no usable pair yet, or the last one is older than max_gap;
  //   too_few_features: fewer than min_tracks tracks (dark, blurred, covered, swapped);
  //   too_few_inliers: no motion explains enough of them;
  //   implausible: beyond max_speed, max_acceleration, max_yaw_rate or max_turn_acceleration;
  //   bad_input: another size than the calibration's, or a stamp not after the last one (after
  //   max_stale_pairs old stamps in a row time is taken to have been set back).
  // A pair is usable when it shows enough stereo features itself; it is then what the next one is
  // compared with, whatever became of its own motion.
  RelativeMotion process(const StereoPair& pair);

  // What the pairs so far say is missing in every disparity, px (disparity_offset.h); already added
  // to what the motions use.
  double disparity_offset() const;

  // msgs/archive.h: what the pairs so far have left behind, about 1 MB (two images of 0.5 Mpx).
  // Loading throws ArchiveError, and changes nothing, where the archive is of another calibration,
  // other parameters or another version, or broken.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::stereo
