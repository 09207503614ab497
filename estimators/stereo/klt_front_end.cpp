#include "estimators/stereo/klt_front_end.h"

#include "msgs/archive.h"

namespace maploop::stereo {

KltFrontEnd::KltFrontEnd(const StereoCalibration& camera, const StereoParameters& parameters)
    : camera_(camera), parameters_(parameters), detector_(parameters) {}

void KltFrontEnd::follow(const StereoFrame& reference, const StereoFrame& current,
                         const std::optional<Eigen::Isometry3d>& expected,
                         std::vector<StereoTrack>* tracks) {
  track_features(camera_, parameters_, reference, current, features_, expected, tracks);
}

std::size_t KltFrontEnd::complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                                  std::span<const int> agreeing) {
  next_features_.clear();
  taken_.clear();
  for (const int i : agreeing) {
    const StereoTrack& track = tracks[static_cast<std::size_t>(i)];
    next_features_.push_back({track.id, track.current});
    taken_.emplace_back(static_cast<float>(track.current.u_left),
                        static_cast<float>(track.current.v_left));
  }
  detector_.detect(current.left, taken_, &corners_);
  match_new_corners(current, parameters_, corners_, &matched_);
  for (const StereoObservation& seen : matched_) next_features_.push_back({next_id_++, seen});
  return next_features_.size();
}

// The number of features is bounded, since each keeps min_feature_distance from the others.
std::size_t KltFrontEnd::largest_archive() const {
  const auto apart = static_cast<std::size_t>(parameters_.min_feature_distance) + 1;
  const std::size_t pixels =
      static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
  return pixels / (apart * apart) * sizeof(Feature) + 64;
}

void KltFrontEnd::save(ArchiveWriter& ar) const {
  ar(features_, next_id_);
}

void KltFrontEnd::load(ArchiveReader& ar, const StereoFrame&) {
  ar(features_, next_id_);
}

}  // namespace maploop::stereo
