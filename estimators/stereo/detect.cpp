#include "estimators/stereo/detect.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace maploop::stereo {
namespace {

constexpr int response_radius = 3;

}  // namespace

double corner_response(const cv::Mat& gradient, int x, int y) {
  int xx = 0, xy = 0, yy = 0;  // 49 products of at most 4080^2 each do not overflow
  for (int row = y - response_radius; row <= y + response_radius; ++row) {
    const auto* g = gradient.ptr<cv::Vec2s>(row);
    for (int column = x - response_radius; column <= x + response_radius; ++column) {
      const int gx = g[column][0];
      const int gy = g[column][1];
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  }
  constexpr double response_side = 2 * response_radius + 1;
  constexpr double response_scale = 1.0 / (32.0 * 32.0 * response_side * response_side);
  const double half_trace = 0.5 * response_scale * (static_cast<double>(xx) + yy);
  const double half_difference = 0.5 * response_scale * (static_cast<double>(xx) - yy);
  return half_trace - std::hypot(half_difference, response_scale * static_cast<double>(xy));
}

void CornerDetector::block_around(int x, int y) {
  const int r = parameters_.min_feature_distance;
  const cv::Rect square(x - r, y - r, 2 * r + 1, 2 * r + 1);
  blocked_(square & cv::Rect(0, 0, blocked_.cols, blocked_.rows)).setTo(255);
}

void CornerDetector::propose(const ImagePyramid& image, const BucketGrid& grid) {
  const cv::Mat& full = image.level(0);
  cv::FAST(full, keypoints_, parameters_.fast_threshold, true);
  const int margin = std::max(parameters_.window / 2 + 1, response_radius);
  candidates_.clear();
  for (const cv::KeyPoint& keypoint : keypoints_) {
    const int x = static_cast<int>(keypoint.pt.x);
    const int y = static_cast<int>(keypoint.pt.y);
    if (x < margin || y < margin || x >= full.cols - margin || y >= full.rows - margin) continue;
    const std::size_t bucket = grid.bucket_of(x, y);
    if (held_[bucket] >= parameters_.features_per_bucket || blocked_.at<unsigned char>(y, x))
      continue;
    const double response = corner_response(image.gradient(0), x, y);
    if (response >= parameters_.min_corner_response)
      candidates_.push_back({bucket, response, x, y});
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    if (a.response != b.response) return a.response > b.response;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
}

void CornerDetector::detect(const ImagePyramid& image, const std::vector<cv::Point2f>& taken,
                            std::vector<cv::Point2f>* corners) {
  const cv::Mat& full = image.level(0);
  const BucketGrid grid(full.cols, full.rows, parameters_.bucket_size);
  held_.assign(grid.count(), 0);
  blocked_.create(full.size(), CV_8UC1);
  blocked_.setTo(0);
  for (const cv::Point2f& point : taken) {
    const int x = std::clamp(static_cast<int>(std::lround(point.x)), 0, full.cols - 1);
    const int y = std::clamp(static_cast<int>(std::lround(point.y)), 0, full.rows - 1);
    ++held_[grid.bucket_of(x, y)];
    block_around(x, y);
  }

  propose(image, grid);
  corners->clear();
  for (const Candidate& candidate : candidates_) {
    int& held = held_[candidate.bucket];
    if (held >= parameters_.features_per_bucket ||
        blocked_.at<unsigned char>(candidate.y, candidate.x))
      continue;
    ++held;
    block_around(candidate.x, candidate.y);
    corners->emplace_back(static_cast<float>(candidate.x), static_cast<float>(candidate.y));
  }
}

}  // namespace maploop::stereo
