// Visual odometry from rectified stereo pairs, one motion a pair.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/stage_listener.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"
#include "msgs/image.h"
#include "msgs/visual_motion.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::stereo {

// Corners spread by buckets are followed around a circle of four images, triangulated, resected
// (P3P in RANSAC) and adjusted, unless parameters.matching and motion name another way
// (after Kitt, Geiger and Lategahn, "Visual Odometry based on Stereo Image Sequences
// with RANSAC-based Outlier Rejection Scheme", IV 2010).
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
  //   too_few_features: fewer than min_tracks tracks (blurred, covered), and where the reason is
  //   seen too_dark or swapped_images (diagnosis.h);
  //   repeated_image: a pixel for pixel copy of the last usable pair's;
  //   too_few_inliers: no motion explains enough of them;
  //   moving_objects: what most tracks agree on no vehicle does, but the others agree on what one
  //   can do;
  //   implausible: beyond max_speed, max_acceleration, max_yaw_rate or max_turn_acceleration;
  //   bad_input: another size than the calibration's, or a stamp not after the last one (after
  //   max_stale_pairs old stamps in a row time is taken to have been set back).
  // An ok motion is called a standstill where the image moved less than standstill_flow, and
  // after_gap where pairs are missing or were refused in between.
  //
  // A pair is usable when it shows enough stereo features itself; it is then what the next one is
  // compared with, whatever became of its own motion.
  VisualMotion process(const StereoPair& pair);

  // Called at the end of each stage from the next call of process() on.
  void on_stage(StageListener listener);

  // What the front end gave to the back end for the last pair: every feature followed to it from
  // the pair it was compared with, before any was judged. Valid until the next call.
  std::span<const StereoTrack> tracks() const;

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
