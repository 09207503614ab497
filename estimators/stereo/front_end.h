// What finds the tracks that the back end makes motions of.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
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

// A pair is compared with the reference, completed, and adopted as the next reference or not.
class FrontEnd {
 public:
  virtual ~FrontEnd() = default;

  // Features of the reference that the current pair shows as well. `expected`: T_current_previous
  // in cam, where the motion can be foreseen.
  virtual void follow(const StereoFrame& reference, const StereoFrame& current,
                      const std::optional<Eigen::Isometry3d>& expected,
                      std::vector<StereoTrack>* tracks) = 0;

  // Ends the current pair: the tracks named, which agree with the vehicle's motion, go on (the
  // others may be on something that moves), and new features join them. Returns how many features
  // the pair has then.
  virtual std::size_t complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                               std::span<const int> agreeing) = 0;

  // The completed pair is the next reference.
  virtual void adopt() = 0;

  // What follow() needs to know of the reference besides its images.
  virtual std::size_t largest_archive() const = 0;
  virtual void save(ArchiveWriter& ar) const = 0;
  virtual void load(ArchiveReader& ar, const StereoFrame& reference) = 0;
};

// The one that parameters.matching names.
std::unique_ptr<FrontEnd> make_front_end(const StereoCalibration& camera,
                                         const StereoParameters& parameters);

}  // namespace maploop::stereo
