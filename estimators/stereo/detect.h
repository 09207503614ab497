// Corners, spread over the image by buckets (internal: uses OpenCV).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "estimators/stereo/image_pyramid.h"
#include "estimators/stereo/parameters.h"

namespace maploop::stereo {

// Smaller eigenvalue of the mean gradient tensor in the 7 x 7 pixels around (x, y), in squared grey
// levels per pixel (Shi and Tomasi, "Good Features to Track", CVPR 1994, section 3). The square
// must lie in the image.
double corner_response(const cv::Mat& gradient, int x, int y);

// The grid of buckets, and how many features each still wants.
class BucketGrid {
 public:
  BucketGrid(int width, int height, int bucket_size)
      : size_(bucket_size),
        columns_((width + bucket_size - 1) / bucket_size),
        rows_((height + bucket_size - 1) / bucket_size) {}

  std::size_t count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  std::size_t bucket_of(int x, int y) const {
    return static_cast<std::size_t>(y / size_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x / size_);
  }

 private:
  int size_;
  int columns_;
  int rows_;
};

// New corners for the buckets that hold fewer than features_per_bucket of `taken`, strongest first
// in each: FAST proposes, the corner response ranks. None closer than min_feature_distance to
// another or to `taken`. The same image and features give the same corners in the same order.
class CornerDetector {
 public:
  explicit CornerDetector(const StereoParameters& parameters) : parameters_(parameters) {}

  void detect(const ImagePyramid& image, const std::vector<cv::Point2f>& taken,
              std::vector<cv::Point2f>* corners);

 private:
  struct Candidate {
    std::size_t bucket;
    double response;
    int x, y;
  };

  void propose(const ImagePyramid& image, const BucketGrid& grid);
  void block_around(int x, int y);

  const StereoParameters parameters_;
  std::vector<int> held_;  // features per bucket
  std::vector<cv::KeyPoint> keypoints_;
  std::vector<Candidate> candidates_;
  cv::Mat blocked_;  // 255 where a feature is too near
};

}  // namespace maploop::stereo
