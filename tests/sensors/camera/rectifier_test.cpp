#include "sensors/camera/rectifier.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "sensors/replay/keyed_text.h"
#include "sensors/replay/kitti_calibration.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

StereoRig kitti_rig() {
  const auto file = testing::real_data() / "kitti/2011_09_26/calib_cam_to_cam.txt";
  return parse_kitti_rig(read_calibration_text(file), file);
}

// Returns grey waves that differ everywhere.
GreyImage waves(int width, int height) {
  GreyImage image;
  image.resize(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image.pixels[static_cast<std::size_t>(v * width + u)] = static_cast<std::uint8_t>(
          128.0 + 60.0 * std::sin(0.05 * u + 0.02 * v) + 60.0 * std::sin(0.03 * v - 0.01 * u));
  return image;
}

cv::Mat as_cv(const Eigen::Matrix3d& m) {
  return (cv::Mat_<double>(3, 3) << m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0),
          m(2, 1), m(2, 2));
}

TEST(Rectifier, AgreesWithOpenCVsOwnMaps) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const StereoRig rig = kitti_rig();
  StereoPair raw, rectified;
  raw.left = raw.right = waves(rig.width, rig.height);
  raw.sequence = 7;
  Rectifier(rig).rectify(raw, rectified);
  EXPECT_EQ(rectified.sequence, 7u);
  const StereoCalibration& r = rig.rectified;
  for (const bool left : {true, false}) {
    const CameraModel& c = left ? rig.left : rig.right;
    const Distortion& d = c.distortion;
    cv::Mat x, y, expected;
    const cv::Mat k = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
    const cv::Mat p = (cv::Mat_<double>(3, 3) << r.fx, 0, r.cx, 0, r.fy, r.cy, 0, 0, 1);
    const cv::Mat coefficients = (cv::Mat_<double>(5, 1) << d.k1, d.k2, d.p1, d.p2, d.k3);
    cv::initUndistortRectifyMap(k, coefficients, as_cv(left ? rig.R_rect_left : rig.R_rect_right),
                                p, {r.width, r.height}, CV_32FC1, x, y);
    cv::remap(cv::Mat(rig.height, rig.width, CV_8UC1, raw.left.pixels.data()), expected, x, y,
              cv::INTER_LINEAR);
    GreyImage& image = left ? rectified.left : rectified.right;
    ASSERT_EQ(image.width, r.width);
    const cv::Mat made(r.height, r.width, CV_8UC1, image.pixels.data());
    EXPECT_LE(cv::norm(made, expected, cv::NORM_INF), 2.0);
  }
}

TEST(Rectifier, AllocatesNothingOnceItsBuffersAreThere) {
  MAPLOOP_REQUIRE_REAL_DATA();
  if (!testing::counts_allocations()) GTEST_SKIP() << "SKIPPED: a sanitizer owns malloc";
  const StereoRig rig = kitti_rig();
  const Rectifier rectifier(rig);
  StereoPair raw, rectified;
  raw.left = raw.right = waves(rig.width, rig.height);
  for (int warm_up = 0; warm_up < 3; ++warm_up) rectifier.rectify(raw, rectified);
  const long before = testing::thread_allocations();
  for (int i = 0; i < 5; ++i) rectifier.rectify(raw, rectified);
  EXPECT_EQ(testing::thread_allocations(), before);
}

TEST(Rectifier, RefusesImagesOfAnotherSizeAndRigsThatFitNowhere) {
  MAPLOOP_REQUIRE_REAL_DATA();
  StereoRig rig = kitti_rig();
  StereoPair raw, rectified;
  raw.left = raw.right = waves(rig.width - 1, rig.height);
  EXPECT_THROW(Rectifier(rig).rectify(raw, rectified), std::invalid_argument);
  rig.T_right_left.translation() *= -1.0;  // left and right swapped
  EXPECT_THROW(Rectifier{rig}, std::invalid_argument);
  rig = kitti_rig();
  rig.left.distortion.k1 = -50.0;
  EXPECT_THROW(Rectifier{rig}, std::invalid_argument);
}

TEST(CameraModel, RaysAndPixelsAreInverseAndAgreeWithOpenCV) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const CameraModel camera = kitti_rig().left;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1391, 511),
                                       Eigen::Vector2d(690, 233), Eigen::Vector2d(1391, 0)}) {
    const auto ray = ray_of(camera, pixel);
    ASSERT_TRUE(ray);
    EXPECT_LT((*project(camera, *ray) - pixel).norm(), 1e-8);
  }
  EXPECT_FALSE(project(camera, {5.0, 0.0})) << "far outside, where the polynomial turns back";
}

// Five coefficients reverse those of an ordinary lens to a few tenths of a pixel, but not those of
// KITTI's wide lenses at the corners of the image; the reported error shows this.
TEST(CameraModel, CoefficientsOfTheOtherDirectionUndistort) {
  const CameraModel camera{700.0, 702.0, 611.0, 180.0, {-0.15, 0.04, 0.0005, -0.0003, -0.002}};
  const ReversedDistortion back = reversed(camera, 1242, 375);
  EXPECT_LT(back.largest_error, 0.5);
  for (const Eigen::Vector2d& ray : {Eigen::Vector2d(0.5, 0.2), Eigen::Vector2d(-0.7, -0.2)}) {
    const Eigen::Vector2d distorted = camera.normalized(*project(camera, ray));
    EXPECT_LT((apply(back.distortion, distorted).point - ray).norm() * camera.fx, 0.5);
  }
  CameraModel there = camera;
  there.distortion = back.distortion;
  const ReversedDistortion again = from_reversed(there, 1242, 375);
  EXPECT_LT(again.largest_error, 0.5);
  there.distortion = again.distortion;
  const Eigen::Vector2d ray(0.5, 0.2);
  EXPECT_LT((*project(there, ray) - *project(camera, ray)).norm(), 0.5);
}

}  // namespace
}  // namespace maploop::sensors
