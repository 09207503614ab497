// A drive stretch is a part of a drive: its length, a mean along it, and its track.
#pragma once

#include <array>
#include <cstddef>

#include "msgs/local_frame.h"
#include "msgs/map_doubt.h"

namespace maploop::mapmatch {

// The track has a point every 10 m. Of one longer than there is room for, the point goes that tells
// least of its shape: the one that makes the smallest triangle with its neighbours (Visvalingam and
// Whyatt, "Line generalisation by repeated elimination of points", 1993).
class DriveStretch {
 public:
  DriveStretch() = default;
  explicit DriveStretch(Time begin) : begin_(begin) {}

  // Takes the next place, `metres` after the one before, and the P that holds for these metres.
  void add(const Geodetic& place, double metres, double probability);

  // Returns the length in m.
  double length() const { return length_; }
  // Returns the mean of P along the stretch; 0 if it has no length.
  double probability() const { return length_ > 0.0 ? weighted_ / length_ : 0.0; }
  // Sets the begin, the length and the track of a doubt.
  void describe(MapDoubt& doubt) const;

  template <class Archive>
  void archive(Archive& ar) {
    ar(begin_, length_, weighted_, next_point_, track_, count_);
    if constexpr (Archive::loading) {
      if (count_ > track_.size()) ar.fail("a stretch has more points than it has room for");
    }
  }

 private:
  void drop_point();

  Time begin_{};
  double length_ = 0.0;      // m
  double weighted_ = 0.0;    // m, the integral of P
  double next_point_ = 0.0;  // m from the begin
  std::array<Geodetic, MapDoubt::max_points> track_{};
  std::size_t count_ = 0;
};

}  // namespace maploop::mapmatch
