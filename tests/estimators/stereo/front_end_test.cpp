#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "estimators/stereo/detect.h"
#include "estimators/stereo/row_search.h"
#include "estimators/stereo/stereo_match.h"
#include "estimators/stereo/track.h"
#include "tests/estimators/stereo/synthetic_scene.h"
#include "tests/estimators/stereo/textured_pair.h"

namespace maploop::stereo {
namespace {

using maploop::testing::small_camera;
using maploop::testing::TexturedWall;

constexpr int image_width = 640, image_height = 240;

StereoFrame frame_of(const StereoPair& pair, const StereoParameters& parameters) {
  StereoFrame frame;
  frame.left.build(pair.left, parameters);
  frame.right.build(pair.right, parameters);
  return frame;
}

std::vector<cv::Point2f> corners_of(const StereoFrame& frame, const StereoParameters& parameters,
                                    const std::vector<cv::Point2f>& taken = {}) {
  std::vector<cv::Point2f> corners;
  CornerDetector(parameters).detect(frame.left, taken, &corners);
  return corners;
}

TEST(CornerDetector, FillsBucketsWithoutExceedingThemAndKeepsItsDistance) {
  const StereoParameters parameters;
  const StereoFrame frame =
      frame_of(TexturedWall().pair(image_width, image_height, 0.0, 20.0), parameters);
  const auto corners = corners_of(frame, parameters);
  EXPECT_GT(corners.size(), 100u);
  const auto distance = static_cast<float>(parameters.min_feature_distance);
  const BucketGrid grid(image_width, image_height, parameters.bucket_size);
  std::map<std::size_t, int> held;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    ++held[grid.bucket_of(static_cast<int>(corners[i].x), static_cast<int>(corners[i].y))];
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_TRUE(std::abs(corners[i].x - corners[j].x) > distance ||
                  std::abs(corners[i].y - corners[j].y) > distance);
  }
  for (const auto& [bucket, count] : held) EXPECT_LE(count, parameters.features_per_bucket);
}

TEST(CornerDetector, OnlyRefillsBucketsThatLostFeatures) {
  const StereoParameters parameters;
  const StereoFrame frame =
      frame_of(TexturedWall().pair(image_width, image_height, 0.0, 20.0), parameters);
  const std::vector<cv::Point2f> taken = {{110.0f, 110.0f}, {125.0f, 125.0f}, {140.0f, 140.0f}};
  for (const cv::Point2f& corner : corners_of(frame, parameters, taken))
    EXPECT_FALSE(corner.x >= 100.0f && corner.x < 150.0f && corner.y >= 100.0f &&
                 corner.y < 150.0f);
}

TEST(CornerDetector, FindsNothingOnAFlatImage) {
  StereoPair pair;
  pair.left.resize(image_width, image_height);
  pair.right = pair.left;
  EXPECT_TRUE(corners_of(frame_of(pair, {}), {}).empty());
}

TEST(CornerResponse, IsHighAtACornerAndNoneAlongAnEdge) {
  StereoPair pair;
  pair.left.resize(image_width, image_height);
  for (int y = 0; y < image_height; ++y)
    for (int x = 0; x < image_width; ++x)
      pair.left.pixels[static_cast<std::size_t>(y * image_width + x)] =
          x >= 100 && y >= 100 ? 200 : 50;
  pair.right = pair.left;
  const StereoFrame frame = frame_of(pair, {});
  EXPECT_GT(corner_response(frame.left.gradient(0), 100, 100), 200.0);
  EXPECT_NEAR(corner_response(frame.left.gradient(0), 100, 150), 0.0, 1e-9);
}

TEST(RowSearch, FindsTheShiftOfATexturedPatchAndRefusesRepeatingOnes) {
  const StereoPair pair = TexturedWall().pair(image_width, image_height, 0.0, 23.0);
  const auto view = [](const GreyImage& image) {
    return PixelView{image.pixels.data(), image.width, image.width, image.height};
  };
  RowSearch search;
  EXPECT_EQ(search.best_disparity(view(pair.left), view(pair.right), 200, 100, 60, 0.8), 23);
  EXPECT_LT(search.best_disparity(view(pair.left), view(pair.right), 2, 100, 60, 0.8), 0) << "rim";
  GreyImage fence = pair.left;
  for (int y = 0; y < image_height; ++y)
    for (int x = 0; x < image_width; ++x)
      fence.pixels[static_cast<std::size_t>(y * image_width + x)] =
          static_cast<std::uint8_t>(128 + (x % 12 < 6 ? 60 : -60) + y % 7);
  EXPECT_LT(search.best_disparity(view(fence), view(fence), 200, 100, 60, 0.8), 0);
}

TEST(StereoMatch, MeasuresASubpixelDisparity) {
  const StereoParameters parameters;
  const StereoFrame frame =
      frame_of(TexturedWall().pair(image_width, image_height, 0.0, 20.3), parameters);
  std::vector<StereoObservation> matched;
  match_new_corners(frame, parameters, corners_of(frame, parameters), &matched);
  ASSERT_GT(matched.size(), 100u);
  double sum = 0.0;
  for (const StereoObservation& seen : matched) {
    EXPECT_NEAR(seen.disparity(), 20.3, 0.15);
    sum += seen.disparity();
  }
  EXPECT_NEAR(sum / static_cast<double>(matched.size()), 20.3, 0.02);
}

TEST(StereoMatch, LeavesOutDisparitiesBeyondTheLimits) {
  const StereoParameters parameters;
  for (const double disparity : {-20.0, 0.4, 180.0}) {
    const StereoFrame frame =
        frame_of(TexturedWall().pair(image_width, image_height, 0.0, disparity), parameters);
    const auto corners = corners_of(frame, parameters);
    std::vector<StereoObservation> matched;
    match_new_corners(frame, parameters, corners, &matched);
    EXPECT_LT(matched.size(), corners.size() / 20) << "disparity " << disparity;
  }
}

TEST(Track, ClosesTheCircleWithAndWithoutAnExpectedMotion) {
  const StereoParameters parameters;
  const StereoCalibration camera = small_camera();
  const TexturedWall wall;
  const double disparity = 20.0, moved = 7.4;  // px to the left
  const StereoFrame before =
      frame_of(wall.pair(image_width, image_height, 0.0, disparity), parameters);
  const StereoFrame after =
      frame_of(wall.pair(image_width, image_height, moved, disparity), parameters);
  std::vector<StereoObservation> matched;
  match_new_corners(before, parameters, corners_of(before, parameters), &matched);
  std::vector<Feature> features;
  for (const StereoObservation& seen : matched)
    features.push_back({static_cast<std::int64_t>(features.size()), seen});

  Eigen::Isometry3d sideways = Eigen::Isometry3d::Identity();
  sideways.translation().x() = -(moved - 1.0) / disparity * camera.baseline;  // wrong by one pixel
  for (const auto& expected : {std::optional<Eigen::Isometry3d>(), std::optional(sideways)}) {
    std::vector<StereoTrack> tracks;
    track_features(camera, parameters, before, after, features, expected, &tracks);
    EXPECT_GT(tracks.size(), matched.size() * 9 / 10);
    std::size_t exact = 0;
    for (const StereoTrack& track : tracks)
      if (std::abs(track.current.u_left - track.previous.u_left + moved) < 0.1 &&
          std::abs(track.current.v_left - track.previous.v_left) < 0.1 &&
          std::abs(track.current.disparity() - disparity) < 0.1)
        ++exact;
    EXPECT_GT(exact, tracks.size() * 9 / 10);
  }
}

}  // namespace
}  // namespace maploop::stereo
