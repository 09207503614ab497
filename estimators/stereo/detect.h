// Corners are detected here and spread over the image by buckets (internal: uses OpenCV).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "estimators/stereo/image_pyramid.h"
#include "estimators/stereo/parameters.h"

namespace maploop::stereo {

// Returns the smaller eigenvalue of the mean gradient tensor in the 7 x 7 pixels around (x, y), in
// squared grey levels per pixel (Shi and Tomasi, "Good Features to Track", CVPR 1994, section 3).
// The square must lie within the image.
double corner_response(const cv::Mat& gradient, int x, int y);

// The grid divides the image into square buckets of `bucket_size` px.
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

// Finds new corners for the buckets that hold fewer than features_per_bucket of `taken`, in each
// bucket the strongest first: FAST proposes, and the corner response ranks. Each corner is at least
// min_feature_distance from all others and from `taken`. The same image and features give the same
// corners in the same order. Not thread-safe.
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
  cv::Mat blocked_;  // 255 in pixels too near to a feature
};

}  // namespace maploop::stereo
