#include "mapmatch/drive_stretch.h"

#include <algorithm>

namespace maploop::mapmatch {

void DriveStretch::add(const Geodetic& place, double metres, double probability) {
  length_ += metres;
  weighted_ += metres * probability;
  if (length_ < next_point_) return;
  if (count_ == track_.size()) {
    count_ /= 2;
    for (std::size_t i = 0; i < count_; ++i) track_[i] = track_[2 * i];
    spacing_ *= 2.0;
  }
  track_[count_++] = {place.latitude, place.longitude, 0.0};
  next_point_ = length_ + spacing_;
}

void DriveStretch::describe(MapDoubt& doubt) const {
  doubt.begin = begin_;
  doubt.length = length_;
  doubt.track = track_;
  doubt.track_count = count_;
}

}  // namespace maploop::mapmatch
