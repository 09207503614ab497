// From the images of raw cameras to rectified ones.
#pragma once

#include <memory>

#include "msgs/image.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Looks every rectified pixel up in a map made beforehand, between the four raw pixels around it
// (positions to 1/256 px). What the raw camera does not see is black. One thread at a time;
// allocates nothing once `rectified` has had its size.
class Rectifier {
 public:
  // Throws std::invalid_argument that says what is wrong with the rig (problem_of()).
  explicit Rectifier(const StereoRig& rig);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  // Images of another size than the rig's throw std::invalid_argument. Two different pairs. Stamps
  // and number go along.
  void rectify(const StereoPair& raw, StereoPair& rectified) const;

 private:
  struct Maps;
  std::unique_ptr<Maps> maps_;
};

// The rectified pairs of raw ones. Pairs available up to `passed` have no pixels to rectify.
std::unique_ptr<Source<StereoPair>> make_rectified_source(std::unique_ptr<Source<StereoPair>> raw,
                                                          const StereoRig& rig,
                                                          Time passed = Time::min());

}  // namespace maploop::sensors
