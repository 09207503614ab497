#include "estimators/stereo/stereo_odometry.h"

#include <optional>
#include <utility>

#include "estimators/stereo/back_end.h"
#include "estimators/stereo/detect.h"
#include "estimators/stereo/parameter_fields.h"
#include "estimators/stereo/track.h"
#include "estimators/stereo/validate.h"
#include "msgs/archive.h"

namespace maploop::stereo {

class StereoOdometry::Implementation {
 public:
  Implementation(const StereoCalibration& calibration, const StereoParameters& parameters)
      : camera_(calibration),
        parameters_(parameters),
        detector_(parameters),
        back_end_(calibration, parameters) {}

  RelativeMotion process(const StereoPair& pair) {
    RelativeMotion result;
    result.stamp = pair.stamp;
    result.available = pair.available;
    result.sequence = pair.sequence;
    if (!acceptable(pair)) {
      result.status = OdometryStatus::bad_input;
      return result;
    }
    current_.left.build(pair.left, parameters_);
    current_.right.build(pair.right, parameters_);

    next_features_.clear();
    if (comparable(pair.stamp)) {
      result.from = reference_stamp_;
      follow_features(&result);
    }
    replenish();
    adopt_reference(pair.stamp, result.status);
    return result;
  }

  double disparity_offset() const { return back_end_.disparity_offset(); }

  // The rest are buffers of one call; the random numbers of a pair come from its stamp alone.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("stereo odometry", 1);
    archive_same(ar, "calibration", camera_);
    archive_same_fields(ar, parameters_);
    ar(has_reference_, reference_stamp_, features_, next_id_, stale_pairs_, back_end_);
    if (!has_reference_) return;
    archive_image(ar, reference_.left);
    archive_image(ar, reference_.right);
  }

  // Two images, features that keep their distance, and the window.
  std::size_t largest_archive() const {
    const std::size_t pixels =
        static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    const auto apart = static_cast<std::size_t>(parameters_.min_feature_distance) + 1;
    return 2 * pixels + pixels / (apart * apart) * sizeof(Feature) +
           Window::largest_archive(parameters_) + 4096;
  }

  std::unique_ptr<Implementation> fresh() const {
    return std::make_unique<Implementation>(camera_, parameters_);
  }

 private:
  // A pyramid is built again from its image, to the same bits.
  template <class Archive>
  void archive_image(Archive& ar, ImagePyramid& pyramid) {
    if constexpr (!Archive::loading) pyramid.copy_image(&archived_);
    ar(archived_);
    if constexpr (Archive::loading) {
      if (!has_size(archived_, camera_)) ar.fail("an image of another size than the calibration's");
      pyramid.build(archived_, parameters_);
    }
  }

  bool acceptable(const StereoPair& pair) {
    if (!has_size(pair.left, camera_) || !has_size(pair.right, camera_)) return false;
    if (has_reference_ && pair.stamp <= reference_stamp_) {
      if (++stale_pairs_ < parameters_.max_stale_pairs) return false;
      has_reference_ = false;
    }
    stale_pairs_ = 0;
    return true;
  }

  bool comparable(Time stamp) const {
    return has_reference_ && to_seconds(stamp - reference_stamp_) <= parameters_.max_gap;
  }

  // Features that agree with an accepted motion go on; the others may be on a moving object.
  void follow_features(RelativeMotion* result) {
    const double seconds = to_seconds(result->stamp - result->from);
    const std::optional<Eigen::Isometry3d> expected =
        back_end_.expected_motion(result->stamp, seconds);
    track_features(camera_, parameters_, reference_, current_, features_,
                   expected ? std::optional(expected->inverse()) : std::nullopt, &tracks_);
    for (const int i : back_end_.process(tracks_, result)) {
      const StereoTrack& track = tracks_[static_cast<std::size_t>(i)];
      next_features_.push_back({track.id, track.current});
    }
  }

  void replenish() {
    taken_.clear();
    for (const Feature& feature : next_features_)
      taken_.emplace_back(static_cast<float>(feature.seen.u_left),
                          static_cast<float>(feature.seen.v_left));
    detector_.detect(current_.left, taken_, &corners_);
    match_new_corners(current_, parameters_, corners_, &matched_);
    for (const StereoObservation& seen : matched_) next_features_.push_back({next_id_++, seen});
  }

  // A pair without features of its own (black, covered, swapped) does not replace a good one.
  void adopt_reference(Time stamp, OdometryStatus status) {
    const bool usable = static_cast<int>(next_features_.size()) >= parameters_.min_tracks;
    if (!usable && status != OdometryStatus::ok) return;
    std::swap(reference_, current_);
    features_.swap(next_features_);
    reference_stamp_ = stamp;
    has_reference_ = true;
  }

  StereoCalibration camera_;
  StereoParameters parameters_;
  CornerDetector detector_;

  bool has_reference_ = false;
  Time reference_stamp_{};
  StereoFrame reference_;
  std::vector<Feature> features_;  // of the reference
  std::int64_t next_id_ = 0;
  int stale_pairs_ = 0;

  BackEnd back_end_;

  StereoFrame current_;  // buffers of one call, kept
  std::vector<StereoTrack> tracks_;
  std::vector<Feature> next_features_;
  std::vector<cv::Point2f> taken_, corners_;
  std::vector<StereoObservation> matched_;
  GreyImage archived_;
};

StereoOdometry::StereoOdometry(const StereoCalibration& calibration,
                               const StereoParameters& parameters) {
  validate(calibration);
  validate(parameters);
  implementation_ = std::make_unique<Implementation>(calibration, parameters);
}

StereoOdometry::~StereoOdometry() = default;
StereoOdometry::StereoOdometry(StereoOdometry&&) noexcept = default;
StereoOdometry& StereoOdometry::operator=(StereoOdometry&&) noexcept = default;

double StereoOdometry::disparity_offset() const {
  return implementation_->disparity_offset();
}

RelativeMotion StereoOdometry::process(const StereoPair& pair) {
  return implementation_->process(pair);
}

std::size_t StereoOdometry::largest_archive() const {
  return implementation_->largest_archive();
}

void StereoOdometry::archive(ArchiveWriter& ar) const {
  implementation_->archive(ar);
}

void StereoOdometry::archive(ArchiveReader& ar) {
  auto loaded = implementation_->fresh();
  loaded->archive(ar);
  implementation_ = std::move(loaded);
}

}  // namespace maploop::stereo
