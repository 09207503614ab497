// This front end spreads corners by buckets and follows them by Lucas-Kanade (internal: uses
// OpenCV).
#pragma once

#include "estimators/stereo/detect.h"
#include "estimators/stereo/front_end.h"
#include "estimators/stereo/track.h"

namespace maploop::stereo {

class KltFrontEnd final : public FrontEnd {
 public:
  KltFrontEnd(const StereoCalibration& camera, const StereoParameters& parameters);

  void follow(const StereoFrame& reference, const StereoFrame& current,
              const std::optional<Eigen::Isometry3d>& expected,
              std::vector<StereoTrack>* tracks) override;
  std::size_t complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                       std::span<const int> agreeing) override;
  void adopt() override { features_.swap(next_features_); }

  std::size_t largest_archive() const override;
  void save(ArchiveWriter& ar) const override;
  void load(ArchiveReader& ar, const StereoFrame& reference) override;

 private:
  StereoCalibration camera_;
  StereoParameters parameters_;
  CornerDetector detector_;

  std::vector<Feature> features_;  // of the reference
  std::int64_t next_id_ = 0;

  std::vector<Feature> next_features_;  // buffers of one call, kept to reuse their memory
  std::vector<cv::Point2f> taken_, corners_;
  std::vector<StereoObservation> matched_;
};

}  // namespace maploop::stereo
