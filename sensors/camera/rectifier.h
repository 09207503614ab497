// This file converts the images of raw cameras to rectified images.
#pragma once

#include <memory>

#include "msgs/image.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Looks up each rectified pixel in a map made beforehand, and interpolates between the four raw
// pixels around that place (positions to 1/256 px). Pixels that the raw camera does not see are
// black. One thread at a time; does not allocate once `rectified` has its size.
class Rectifier {
 public:
  // Throws std::invalid_argument that states what is wrong with the rig (see problem_of()).
  explicit Rectifier(const StereoRig& rig);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  // Throws std::invalid_argument if the images are not of the rig's size. The two pairs must be
  // different objects. Stamps and sequence number are copied.
  void rectify(const StereoPair& raw, StereoPair& rectified) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

// Returns a source of rectified pairs. Pairs available up to `passed` have no pixels to rectify.
std::unique_ptr<Source<StereoPair>> make_rectified_source(std::unique_ptr<Source<StereoPair>> raw,
                                                          const StereoRig& rig,
                                                          Time passed = Time::min());

}  // namespace maploop::sensors
