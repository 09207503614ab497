// These are features seen by both cameras at one or two epochs.
#pragma once

#include <cstdint>

namespace maploop::stereo {

// Positions are in rectified pixels; the origin is the centre of the top left pixel.
struct StereoObservation {
  double u_left = 0.0, v_left = 0.0;
  double u_right = 0.0, v_right = 0.0;

  double disparity() const { return u_left - u_right; }
};

template <class Archive>
void archive(Archive& ar, StereoObservation& o) {
  ar(o.u_left, o.v_left, o.u_right, o.v_right);
}

struct StereoTrack {
  std::int64_t id = 0;
  StereoObservation previous;
  StereoObservation current;
};

}  // namespace maploop::stereo
