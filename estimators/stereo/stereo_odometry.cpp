#include "estimators/stereo/stereo_odometry.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "estimators/stereo/back_end.h"
#include "estimators/stereo/diagnosis.h"
#include "estimators/stereo/klt_front_end.h"
#include "estimators/stereo/parameter_table.h"
#include "estimators/stereo/sift_front_end.h"
#include "msgs/archive.h"
#include "msgs/parameter_archive.h"

namespace maploop::stereo {
namespace {

void require(bool holds, const char* what, const char* must, double value) {
  if (!holds) {
    throw std::invalid_argument("stereo odometry: " + std::string(what) + " must be " + must +
                                ", not " + std::to_string(value));
  }
}

void require_positive(const char* what, double value) {
  require(value > 0.0, what, "positive", value);
}

// Throws std::invalid_argument naming the value, and what it must be.
void validate(const StereoCalibration& calibration) {
  const double smallest = 64.0;  // below this no pyramid of the default height
  require(calibration.width >= smallest, "calibration width", "at least 64 px", calibration.width);
  require(calibration.height >= smallest, "calibration height", "at least 64 px",
          calibration.height);
  require_positive("calibration fx", calibration.fx);
  require_positive("calibration fy", calibration.fy);
  require_positive("calibration baseline (m, right camera to the right)", calibration.baseline);
}

bool has_size(const ImageView& image, const StereoCalibration& calibration) {
  return image.width == calibration.width && image.height == calibration.height;
}

// Returns the front end that parameters.matching selects.
std::unique_ptr<FrontEnd> make_front_end(const StereoCalibration& camera,
                                         const StereoParameters& parameters) {
  if (parameters.matching == Matching::sift)
    return std::make_unique<SiftFrontEnd>(camera, parameters);
  return std::make_unique<KltFrontEnd>(camera, parameters);
}

}  // namespace

class StereoOdometry::Implementation {
 public:
  Implementation(const StereoCalibration& calibration, const StereoParameters& parameters)
      : camera_(calibration),
        parameters_(parameters),
        front_end_(make_front_end(calibration, parameters)),
        back_end_(calibration, parameters) {}

  VisualMotion process(const Sample& pair, const ImageView& left, const ImageView& right) {
    VisualMotion result;
    result.stamp = pair.stamp;
    result.available = pair.available;
    result.sequence = pair.sequence;
    tracks_.clear();
    if (!acceptable(pair.stamp, left, right)) {
      result.status = OdometryStatus::bad_input;
      return result;
    }
    current_.left.build(left, parameters_);
    current_.right.build(right, parameters_);
    notify(stage_, "pyramids");

    std::span<const int> agreeing;
    if (comparable(pair.stamp)) {
      result.from = reference_stamp_;
      if (repeats(current_, reference_)) {
        result.status = OdometryStatus::repeated_image;
        return result;
      }
      agreeing = follow_features(&result);
    }
    const std::size_t features = front_end_->complete(current_, tracks_, agreeing);
    notify(stage_, "detection");
    adopt_reference(pair, static_cast<int>(features), &result);
    return result;
  }

  void on_stage(StageListener listener) {
    back_end_.on_stage(listener);
    stage_ = std::move(listener);
  }

  const std::vector<StereoTrack>& tracks() const { return tracks_; }
  double disparity_offset() const { return back_end_.disparity_offset(); }

  // The other members are buffers of one call; the random numbers of a pair depend on its stamp
  // alone.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("stereo odometry", 3);
    archive_same(ar, "calibration", camera_);
    archive_same_parameters(ar, parameters_);
    ar(has_reference_, reference_stamp_, reference_sequence_, stale_pairs_, back_end_);
    if (has_reference_) {
      archive_image(ar, reference_.left);
      archive_image(ar, reference_.right);
    }
    if constexpr (Archive::loading) {
      front_end_->load(ar, reference_);
    } else {
      front_end_->save(ar);
    }
  }

  // The archive contains two images, the front end's features, and the window.
  std::size_t largest_archive() const {
    const std::size_t pixels =
        static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    // The age of a feature takes less space than the feature.
    return 2 * pixels + 2 * front_end_->largest_archive() + Window::largest_archive(parameters_) +
           4096;
  }

  std::unique_ptr<Implementation> fresh() const {
    auto other = std::make_unique<Implementation>(camera_, parameters_);
    other->on_stage(stage_);
    return other;
  }

 private:
  // A pyramid is rebuilt from its image with the same bits.
  template <class Archive>
  void archive_image(Archive& ar, ImagePyramid& pyramid) {
    if constexpr (!Archive::loading) pyramid.copy_image(&archived_);
    ar(archived_);
    if constexpr (Archive::loading) {
      if (!has_size(archived_, camera_)) ar.fail("an image of another size than the calibration's");
      pyramid.build(archived_, parameters_);
    }
  }

  bool acceptable(Time stamp, const ImageView& left, const ImageView& right) {
    if (!has_size(left, camera_) || !has_size(right, camera_)) return false;
    if (has_reference_ && stamp <= reference_stamp_) {
      if (++stale_pairs_ < parameters_.max_stale_pairs) return false;
      has_reference_ = false;
    }
    stale_pairs_ = 0;
    return true;
  }

  bool comparable(Time stamp) const {
    return has_reference_ && to_seconds(stamp - reference_stamp_) <= parameters_.max_gap;
  }

  // Returns the tracks that agree with an accepted motion.
  std::span<const int> follow_features(VisualMotion* result) {
    const double seconds = to_seconds(result->stamp - result->from);
    const std::optional<Eigen::Isometry3d> expected =
        back_end_.expected_motion(result->stamp, seconds);
    front_end_->follow(reference_, current_,
                       expected ? std::optional(expected->inverse()) : std::nullopt, &tracks_);
    notify(stage_, "tracking");
    const std::vector<int>& agreeing = back_end_.process(tracks_, result);
    if (result->status == OdometryStatus::ok && result->sequence > reference_sequence_ + 1 &&
        result->condition == OdometryCondition::ordinary)
      result->condition = OdometryCondition::after_gap;
    if (result->status == OdometryStatus::ok) back_end_.describe_offset(result);
    return agreeing;
  }

  // A pair without features of its own (black, covered, swapped) must not replace a good one.
  void adopt_reference(const Sample& pair, int features, RelativeMotion* result) {
    if (features < parameters_.min_tracks && result->status != OdometryStatus::ok) {
      result->status = why_few_features(current_, parameters_);
      return;
    }
    std::swap(reference_, current_);
    front_end_->adopt();
    reference_stamp_ = pair.stamp;
    reference_sequence_ = pair.sequence;
    has_reference_ = true;
  }

  StereoCalibration camera_;
  StereoParameters parameters_;
  std::unique_ptr<FrontEnd> front_end_;

  bool has_reference_ = false;
  Time reference_stamp_{};
  std::uint64_t reference_sequence_ = 0;
  StereoFrame reference_;
  int stale_pairs_ = 0;

  BackEnd back_end_;

  StereoFrame current_;  // buffers of one call, kept to reuse their memory
  std::vector<StereoTrack> tracks_;
  GreyImage archived_;
  StageListener stage_;
};

StereoOdometry::StereoOdometry(const StereoCalibration& calibration,
                               const StereoParameters& parameters) {
  validate(calibration);
  validate_parameters(parameters);
  implementation_ = std::make_unique<Implementation>(calibration, parameters);
}

StereoOdometry::~StereoOdometry() = default;
StereoOdometry::StereoOdometry(StereoOdometry&&) noexcept = default;
StereoOdometry& StereoOdometry::operator=(StereoOdometry&&) noexcept = default;

void StereoOdometry::on_stage(StageListener listener) {
  implementation_->on_stage(std::move(listener));
}

std::span<const StereoTrack> StereoOdometry::tracks() const {
  return implementation_->tracks();
}

double StereoOdometry::disparity_offset() const {
  return implementation_->disparity_offset();
}

VisualMotion StereoOdometry::process(const StereoPair& pair) {
  return implementation_->process(pair, pair.left, pair.right);
}

VisualMotion StereoOdometry::process(const Sample& sample, const ImageView& left,
                                     const ImageView& right) {
  return implementation_->process(sample, left, right);
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
