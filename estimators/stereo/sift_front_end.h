// Features found anew in every pair and matched by their descriptors (Lowe, "Distinctive Image
// Features from Scale-Invariant Keypoints", IJCV 60, 2004): the thesis's alternative to tracking.
// (internal: uses OpenCV)
#pragma once

#include <opencv2/features2d.hpp>

#include "estimators/stereo/front_end.h"
#include "estimators/stereo/stereo_match.h"

namespace maploop::stereo {

// Pairs (first, second) whose descriptors are each other's nearest neighbour (symmetry test) and
// nearer than sift_ratio times the second nearest (ratio test). Ascending by first.
std::vector<std::pair<int, int>> match_descriptors(const cv::Mat& first, const cv::Mat& second,
                                                   double ratio);

class SiftFrontEnd final : public FrontEnd {
 public:
  SiftFrontEnd(const StereoCalibration& camera, const StereoParameters& parameters);

  // Matches in the left images that also pass the test of the fundamental matrix (RANSAC). What is
  // expected is not used: descriptors find their like wherever it is.
  void follow(const StereoFrame& reference, const StereoFrame& current,
              const std::optional<Eigen::Isometry3d>& expected,
              std::vector<StereoTrack>* tracks) override;
  std::size_t complete(const StereoFrame& current, std::span<const StereoTrack> tracks,
                       std::span<const int> agreeing) override;
  void adopt() override;

  std::size_t largest_archive() const override;
  void save(ArchiveWriter& ar) const override;
  void load(ArchiveReader& ar, const StereoFrame& reference) override;

 private:
  struct Described {
    std::vector<StereoObservation> seen;
    std::vector<std::int64_t> ids;  // the same feature's in the pair before, where it was matched
    cv::Mat descriptors;            // of the left image, one a row
  };

  // Features of both images of a pair that match along a row.
  void describe(const StereoFrame& frame, Described* described);

  StereoParameters parameters_;
  cv::Ptr<cv::SIFT> sift_;
  Described reference_, current_;
  bool described_ = false;  // current_ is of the pair in hand
  std::int64_t next_id_ = 0;
};

}  // namespace maploop::stereo
