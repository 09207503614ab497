// This class computes visual odometry from rectified stereo pairs, one motion for each pair.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "estimators/stereo/image_view.h"
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
// (P3P in RANSAC) and adjusted, unless parameters.matching and parameters.motion select another
// method (after Kitt, Geiger and Lategahn, "Visual Odometry based on Stereo Image Sequences with
// RANSAC-based Outlier Rejection Scheme", IV 2010).
//
// Not thread-safe. The same pairs give the same bits. The buffers take about 13 MB for images of
// 0.5 Mpx.
class StereoOdometry {
 public:
  // Throws std::invalid_argument, which names the value, if the calibration or a parameter is not
  // valid.
  StereoOdometry(const StereoCalibration& calibration, const StereoParameters& parameters);
  ~StereoOdometry();
  // Moves all state. Afterwards the source may only be assigned to or destroyed.
  StereoOdometry(StereoOdometry&&) noexcept;
  // The same.
  StereoOdometry& operator=(StereoOdometry&&) noexcept;

  // Returns the motion of the body from the newest usable pair before this one (`from`) to this
  // one. stamp, available and sequence are the pair's. Never throws for any image a camera may
  // deliver. A refusal has its reason in `status`, and its pose and covariance are identity and
  // zero:
  //   first_frame: no usable pair yet, or the last one is older than max_gap;
  //   too_few_features: fewer than min_tracks tracks (blurred, covered images), or, if this is the
  //   cause, too_dark or swapped_images (diagnosis.h); repeated_image: an image is a pixel for
  //   pixel copy of the last usable pair's; too_few_inliers: no motion explains enough of the
  //   tracks; moving_objects: most tracks agree on a motion that no vehicle can make, but the
  //   others agree on a possible one; implausible: beyond max_speed, max_acceleration, max_yaw_rate
  //   or max_turn_acceleration; bad_input: the size is not the calibration's, or the stamp is not
  //   after the last one (after max_stale_pairs old stamps in a row the clock is assumed to have
  //   been set back).
  // An ok motion has the condition standstill if the image moved less than standstill_flow, and
  // after_gap if pairs are missing or were refused in between.
  //
  // A pair is usable if it shows enough stereo features itself or its motion is ok. The next pair
  // is then compared with it, even if its own motion was refused.
  VisualMotion process(const StereoPair& pair);
  // The same for images that the caller keeps; `sample` is the stamp of the pair.
  VisualMotion process(const Sample& sample, const ImageView& left, const ImageView& right);

  // Sets the listener that is called at the end of each stage, from the next call of process() on.
  void on_stage(StageListener listener);

  // Returns the tracks that the front end passed to the back end for the last pair: all features
  // followed to it from the reference pair, before any was judged. Valid until the next call.
  std::span<const StereoTrack> tracks() const;

  // Returns the offset of all disparities estimated so far, px (disparity_offset.h). The motions
  // already include it.
  double disparity_offset() const;

  // Archives the state after all pairs so far, about 1 MB (two images of 0.5 Mpx; msgs/archive.h).
  // Loading throws ArchiveError, and changes nothing, if the archive is broken or of another
  // calibration, other parameters or another version.
  std::size_t largest_archive() const;  // bytes
  void archive(ArchiveWriter& ar) const;
  void archive(ArchiveReader& ar);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace maploop::stereo
