#include "mapmatch/drive_stretch.h"

#include <algorithm>
#include <cmath>

namespace maploop::mapmatch {
namespace {

constexpr double spacing = 10.0;  // m

}  // namespace

void DriveStretch::add(const Geodetic& place, double metres, double probability) {
  length_ += metres;
  weighted_ += metres * probability;
  if (length_ < next_point_) return;
  if (count_ == track_.size()) drop_point();
  track_[count_++] = {place.latitude, place.longitude, 0.0};
  next_point_ = length_ + spacing;
}

void DriveStretch::drop_point() {
  // The areas are compared alone, so they are in the units of the track.
  const double narrowing = std::cos(track_[0].latitude);
  const auto area = [&](std::size_t i) {
    const Geodetic &a = track_[i - 1], &b = track_[i], &c = track_[i + 1];
    return std::abs(narrowing * ((b.longitude - a.longitude) * (c.latitude - a.latitude) -
                                 (c.longitude - a.longitude) * (b.latitude - a.latitude)));
  };
  std::size_t least = 1;
  for (std::size_t i = 2; i + 1 < count_; ++i)
    if (area(i) < area(least)) least = i;
  std::shift_left(track_.begin() + static_cast<std::ptrdiff_t>(least), track_.end(), 1);
  --count_;
}

void DriveStretch::describe(MapDoubt& doubt) const {
  doubt.begin = begin_;
  doubt.length = length_;
  doubt.track = track_;
  doubt.track_count = count_;
}

}  // namespace maploop::mapmatch
