#include "estimators/stereo/stereo_match.h"

#include <array>
#include <cmath>

namespace maploop::stereo {
namespace {

constexpr int kPatchRadius = 4;  // px of the half-size image
constexpr int kPatchSide = 2 * kPatchRadius + 1;
constexpr int kPatchPixels = kPatchSide * kPatchSide;
constexpr double kSecondBest = 0.95;  // correlation of a rival elsewhere, relative to the best

struct Patch {
  std::array<int, kPatchPixels> value;
  int sum = 0;
  int squares = 0;
};

Patch read_patch(const cv::Mat& image, int x, int y) {
  Patch patch;
  std::size_t i = 0;
  for (int row = y - kPatchRadius; row <= y + kPatchRadius; ++row) {
    const unsigned char* pixel = image.ptr<unsigned char>(row) + x - kPatchRadius;
    for (int column = 0; column < kPatchSide; ++column) {
      const int value = pixel[column];
      patch.value[i++] = value;
      patch.sum += value;
      patch.squares += value * value;
    }
  }
  return patch;
}

double correlation(const Patch& a, const Patch& b) {
  int products = 0;
  for (std::size_t i = 0; i < kPatchPixels; ++i) products += a.value[i] * b.value[i];
  const double n = kPatchPixels;
  const double covariance = n * products - static_cast<double>(a.sum) * b.sum;
  const double variance_a = n * a.squares - static_cast<double>(a.sum) * a.sum;
  const double variance_b = n * b.squares - static_cast<double>(b.sum) * b.sum;
  const double scale = std::sqrt(variance_a * variance_b);
  return scale > 0.0 ? covariance / scale : 0.0;
}

}  // namespace

double search_row(const StereoFrame& frame, const StereoParameters& parameters,
                  const cv::Point2f& left_point) {
  const cv::Mat& left = frame.left.level(1);
  const cv::Mat& right = frame.right.level(1);
  const int x = static_cast<int>(std::lround(left_point.x / 2.0f));
  const int y = static_cast<int>(std::lround(left_point.y / 2.0f));
  const auto inside = [&](int column) {
    return column >= kPatchRadius && column < left.cols - kPatchRadius;
  };
  if (!inside(x) || y < kPatchRadius || y >= left.rows - kPatchRadius) return -1.0;

  const Patch wanted = read_patch(left, x, y);
  const int farthest = static_cast<int>(std::ceil(parameters.max_disparity / 2.0));
  double best = -1.0;
  int best_disparity = -1;
  std::vector<double> scores;
  scores.reserve(static_cast<std::size_t>(farthest) + 1);
  for (int d = 0; d <= farthest && inside(x - d); ++d) {
    scores.push_back(correlation(wanted, read_patch(right, x - d, y)));
    if (scores.back() > best) {
      best = scores.back();
      best_disparity = d;
    }
  }
  if (best < parameters.min_correlation) return -1.0;
  for (int d = 0; d < static_cast<int>(scores.size()); ++d)
    if (std::abs(d - best_disparity) > 2 &&
        scores[static_cast<std::size_t>(d)] > kSecondBest * best)
      return -1.0;
  return 2.0 * best_disparity;
}

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
  for (const cv::Point2f& corner : corners) {
    const double disparity = search_row(frame, parameters, corner);
    if (disparity < 0.0) continue;
    left.push_back(corner);
    right.emplace_back(corner.x - static_cast<float>(disparity), corner.y);
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
