// The front end finds the tracks from which the back end computes motions.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop {
class ArchiveReader;
class ArchiveWriter;
}  // namespace maploop

namespace maploop::stereo {

struct StereoFrame;

// A pair is compared with the reference and completed; the caller then may adopt it as the next
// reference. Not thread-safe.
class FrontEnd {
 public:
  virtual ~FrontEnd() = default;

  // Finds the features of the reference that the current pair shows too. `expected` is
  // T_current_previous in cam, if the motion can be predicted.
  virtual void follow(const StereoFrame& reference, const StereoFrame& current,
                      const std::optional<Eigen::Isometry3d>& expected,
                      std::vector<StereoTrack>* tracks) = 0;

  // Completes the current pair: keeps the tracks in `agreeing`, which agree with the vehicle's
  // motion (the others may be on a moving object), and adds new features. Returns the number of
  // features that the pair then has.
  virtual std::size_t complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                               std::span<const int> agreeing) = 0;

  // Makes the completed pair the next reference.
  virtual void adopt() = 0;

  // These archive what follow() needs of the reference besides its images (sizes in bytes).
  virtual std::size_t largest_archive() const = 0;
  virtual void save(ArchiveWriter& ar) const = 0;
  virtual void load(ArchiveReader& ar, const StereoFrame& reference) = 0;
};

}  // namespace maploop::stereo
