#include "estimators/stereo/track_ages.h"

#include <algorithm>

namespace maploop::stereo {

double TrackAges::correlated_pairs(std::span<const StereoTrack> tracks,
                                   std::span<const int> chosen) {
  next_.clear();
  double sum = 0.0;
  for (const int i : chosen) {
    const std::int64_t id = tracks[static_cast<std::size_t>(i)].id;
    const auto known =
        std::lower_bound(ages_.begin(), ages_.end(), id,
                         [](const Age& age, std::int64_t wanted) { return age.id < wanted; });
    const bool older = known != ages_.end() && known->id == id;
    next_.push_back({id, older ? known->pairs + 1 : 0});
    sum += next_.back().pairs;
  }
  std::sort(next_.begin(), next_.end(), [](const Age& a, const Age& b) { return a.id < b.id; });
  ages_.swap(next_);
  return ages_.empty() ? 1.0 : 1.0 + 2.0 * sum / static_cast<double>(ages_.size());
}

}  // namespace maploop::stereo
