// This class counts for how many pairs features have been followed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimators/stereo/tracks.h"

namespace maploop::stereo {

// A feature with a wrong match has the same error throughout its life of L pairs, so these errors
// add up instead of averaging out. Over a time longer than the features' lives, the variance of the
// sum is E[L^2] / E[L] times that of independent errors. This factor is one more than twice the
// mean age (number of earlier pairs) of the living features.
class TrackAges {
 public:
  // Increases the age of each track in `chosen` that was also chosen in the last call; all others
  // start at 0. Returns E[L^2] / E[L] estimated from the ages; 1 if all are new.
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
