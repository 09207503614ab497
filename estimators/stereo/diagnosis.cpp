#include "estimators/stereo/diagnosis.h"

#include <cstring>

#include "estimators/stereo/detect.h"

namespace maploop::stereo {
namespace {

bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return false;
  for (int row = 0; row < a.rows; ++row)
    if (std::memcmp(a.ptr(row), b.ptr(row), static_cast<std::size_t>(a.cols)) != 0) return false;
  return true;
}

}  // namespace

OdometryStatus why_few_features(const StereoFrame& frame, const StereoParameters& parameters) {
  if (cv::mean(frame.left.level(0))[0] < parameters.dark_level) return OdometryStatus::too_dark;
  const StereoFrame exchanged{frame.right, frame.left};
  std::vector<cv::Point2f> corners;
  CornerDetector(parameters).detect(exchanged.left, {}, &corners);
  std::vector<StereoObservation> matched;
  match_new_corners(exchanged, parameters, corners, &matched);
  return static_cast<int>(matched.size()) >= parameters.min_tracks
             ? OdometryStatus::swapped_images
             : OdometryStatus::too_few_features;
}

bool repeats(const StereoFrame& frame, const StereoFrame& earlier) {
  return same_pixels(frame.left.level(0), earlier.left.level(0)) ||
         same_pixels(frame.right.level(0), earlier.right.level(0));
}

}  // namespace maploop::stereo
