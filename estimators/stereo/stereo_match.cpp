#include "estimators/stereo/stereo_match.h"

#include <cmath>

#include "estimators/stereo/row_search.h"

namespace maploop::stereo {
namespace {

PixelView view(const cv::Mat& image) {
  return {image.data, static_cast<std::ptrdiff_t>(image.step), image.cols, image.rows};
}

}  // namespace

bool consistent(const StereoObservation& seen, const StereoParameters& parameters) {
  return std::abs(seen.v_left - seen.v_right) <= parameters.max_row_error &&
         seen.disparity() >= parameters.min_disparity &&
         seen.disparity() <= parameters.max_disparity;
}

void match_new_corners(const StereoFrame& frame, const StereoParameters& parameters,
                       const std::vector<cv::Point2f>& corners,
                       std::vector<StereoObservation>* matched) {
  matched->clear();
  std::vector<cv::Point2f> left, right, back;
  RowSearch search;
  const PixelView half_left = view(frame.left.level(1));
  const PixelView half_right = view(frame.right.level(1));
  const int farthest = static_cast<int>(std::ceil(parameters.max_disparity / 2.0));
  for (const cv::Point2f& corner : corners) {
    const int disparity = search.best_disparity(
        half_left, half_right, static_cast<int>(std::lround(corner.x / 2.0f)),
        static_cast<int>(std::lround(corner.y / 2.0f)), farthest, parameters.min_correlation);
    if (disparity < 0) continue;
    left.push_back(corner);
    right.emplace_back(corner.x - 2.0f * static_cast<float>(disparity), corner.y);
  }
  back = left;
  std::vector<unsigned char> found, found_back;
  track_points(frame.left, frame.right, 1, parameters, left, &right, &found);
  track_points(frame.right, frame.left, 0, parameters, right, &back, &found_back);
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!found[i] || !found_back[i]) continue;
    const StereoObservation seen{left[i].x, left[i].y, right[i].x, right[i].y};
    if (consistent(seen, parameters) && cv::norm(back[i] - left[i]) <= parameters.max_closure)
      matched->push_back(seen);
  }
}

}  // namespace maploop::stereo
