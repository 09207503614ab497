// When snapshots are taken.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "msgs/time.h"

namespace maploop::vehicle {

// At the given moments, and at all multiples of a period since 1970, after `begin`. Both are ticks
// of the fusion.
class SnapshotMoments {
 public:
  SnapshotMoments() = default;
  // `moments` increase. Without a period (0) there are no others.
  SnapshotMoments(std::vector<Time> moments, Duration every, Time begin)
      : moments_(std::move(moments)), every_(every) {
    pass(begin);
  }

  // Returns the first one that was not passed; Time::max(): there is none.
  Time next() const {
    return std::min(next_ < moments_.size() ? moments_[next_] : Time::max(), periodic_);
  }

  // Passes all up to this time.
  void pass(Time t) {
    while (next_ < moments_.size() && moments_[next_] <= t) ++next_;
    if (every_ > Duration(0)) periodic_ = t - t.time_since_epoch() % every_ + every_;
  }

  // From now on there are the given moments alone, since the multiples have no end.
  void end_period() {
    every_ = Duration(0);
    periodic_ = Time::max();
  }

 private:
  std::vector<Time> moments_;
  Duration every_{};
  std::size_t next_ = 0;
  Time periodic_ = Time::max();
};

}  // namespace maploop::vehicle
