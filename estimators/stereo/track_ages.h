// For how many pairs features have been followed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimators/stereo/tracks.h"

namespace maploop::stereo {

// A feature that is matched wrongly is wrong in the same way as long as it lives, so its errors in
// the L pairs of its life add up instead of averaging out: over a time that is longer than lives
// are, the variance of the sum is E[L^2] / E[L] times that of independent errors. That is one more
// than twice the mean age (earlier pairs) of the features that are alive.
class TrackAges {
 public:
  // Those of the tracks named that were named in the last call as well are one pair older, and all
  // others begin. Returns E[L^2] / E[L] as they show it; 1 where all are new.
  double correlated_pairs(std::span<const StereoTrack> tracks, std::span<const int> chosen);

  template <class Archive>
  void archive(Archive& ar) {
    ar(ages_);
  }

 private:
  struct Age {
    std::int64_t id = 0;
    std::int32_t pairs = 0;

    template <class Archive>
    void archive(Archive& ar) {
      ar(id, pairs);
    }
  };

  std::vector<Age> ages_;  // by id
  std::vector<Age> next_;  // buffer
};

}  // namespace maploop::stereo
