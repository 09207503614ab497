// These are features seen by both cameras at one or two epochs.
#pragma once

#include <cstdint>

namespace maploop::stereo {

// Holds where the two cameras see a feature. Positions are in rectified pixels; the origin is the
// centre of the top left pixel.
struct StereoObservation {
  double u_left = 0.0, v_left = 0.0;    // px, column and row in the left image
  double u_right = 0.0, v_right = 0.0;  // px, column and row in the right image

  double disparity() const { return u_left - u_right; }  // px
};

template <class Archive>
void archive(Archive& ar, StereoObservation& o) {
  ar(o.u_left, o.v_left, o.u_right, o.v_right);
}

// Holds a feature that was followed from the reference pair to the current one.
struct StereoTrack {
  std::int64_t id = 0;         // the feature's, kept for as long as it is followed
  StereoObservation previous;  // in the reference pair, the newest usable one before
  StereoObservation current;   // in the current pair
};

}  // namespace maploop::stereo
