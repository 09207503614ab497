// This front end detects features in every pair and matches them by their descriptors (Lowe,
// "Distinctive Image Features from Scale-Invariant Keypoints", IJCV 60, 2004). It is the thesis's
// alternative to tracking. (internal: uses OpenCV)
#pragma once

#include <opencv2/features2d.hpp>

#include "estimators/stereo/front_end.h"
#include "estimators/stereo/stereo_match.h"

namespace maploop::stereo {

// Returns the pairs (first, second) whose descriptors are each other's nearest neighbour (symmetry
// test) and nearer than `ratio` times the second nearest (ratio test), ascending by first.
std::vector<std::pair<int, int>> match_descriptors(const cv::Mat& first, const cv::Mat& second,
                                                   double ratio);

class SiftFrontEnd final : public FrontEnd {
 public:
  SiftFrontEnd(const StereoCalibration& camera, const StereoParameters& parameters);

  // Finds matches in the left images that also pass the test of the fundamental matrix (RANSAC).
  // The expected motion is not used, since descriptors are matched across the whole image.
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
    std::vector<std::int64_t> ids;  // id of the same feature in the previous pair, if matched
    cv::Mat descriptors;            // of the left image, one a row
  };

  // Finds the features of a pair whose left and right images match along a row.
  void describe(const StereoFrame& frame, Described* described);

  StereoParameters parameters_;
  cv::Ptr<cv::SIFT> sift_;
  Described reference_, current_;
  bool described_ = false;  // current_ already describes the current pair
  std::int64_t next_id_ = 0;
};

}  // namespace maploop::stereo
