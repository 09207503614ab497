// Images and the calibration of cameras.
#include "sensors/bag/camera_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "tests/sensors/bag/bag_contents.h"

namespace maploop::sensors {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RosImage made_image(std::string_view encoding, std::uint32_t step, const std::string& data) {
  RosImage image;
  image.encoding = encoding;
  image.width = image.height = 2;
  image.step = step;
  image.data = testing::as_bytes(data);
  return image;
}

TEST(CameraMessage, BecomesGreyFromEachEncoding) {
  GreyImage grey;
  const std::string padded("\1\2..\3\4..", 8);
  to_grey(made_image("mono8", 4, padded), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(1, 2, 3, 4));
  const std::string wide("\0\1\0\2\0\3\0\4", 8);
  to_grey(made_image("mono16", 4, wide), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(1, 2, 3, 4));
  const std::string colours("\377\0\0\0\377\0\0\0\377\144\144\144", 12);
  to_grey(made_image("rgb8", 6, colours), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(76, 150, 29, 100));
  to_grey(made_image("bgr8", 6, colours), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(29, 150, 76, 100));
  // Red 40, green 80, blue 120: a quarter, a half and a quarter.
  const std::string bayer("\50\120\120\170", 4);
  to_grey(made_image("bayer_rggb8", 2, bayer), grey);
  EXPECT_THAT(grey.pixels, ElementsAre(80, 80, 80, 80));
}

TEST(CameraMessage, IsRefusedWithTheReason) {
  const auto refused = [](const RosImage& image) {
    GreyImage grey;
    try {
      to_grey(image, grey);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string four(4, '\1');
  EXPECT_THAT(refused(made_image("yuv422", 4, four)), HasSubstr("'yuv422' is not supported"));
  EXPECT_THAT(refused(made_image("mono8", 1, four)), HasSubstr("too few"));
  EXPECT_THAT(refused(made_image("rgb8", 6, four)), HasSubstr("too few"));
  RosImage huge = made_image("mono8", 0xffffffff, four);
  huge.width = huge.height = 0xffffffff;
  EXPECT_THAT(refused(huge), HasSubstr("out of range"));
}

RosCameraInfo info_of(const CameraModel& camera, const Eigen::Matrix3d& R, double tx) {
  RosCameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  const Distortion& d = camera.distortion;
  info.d = {d.k1, d.k2, d.p1, d.p2, d.k3};
  const double k[9] = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  const double p[12] = {500, 0, 320, tx, 0, 500, 240, 0, 0, 0, 1, 0};
  std::copy_n(k, 9, info.k);
  std::copy_n(p, 12, info.p);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(info.r) = R;
  return info;
}

TEST(StereoMessages, GiveTheRigOfRawImages) {
  const CameraModel camera{510, 512, 318, 243, {-0.3, 0.1, 0.001, -0.002, 0.0}};
  const Eigen::Matrix3d R_left = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()).matrix();
  const Eigen::Matrix3d R_right = Eigen::AngleAxisd(-0.02, Eigen::Vector3d::UnitX()).matrix();
  const RosStereo stereo =
      stereo_of(info_of(camera, R_left, 0), info_of(camera, R_right, -60), false);
  ASSERT_TRUE(stereo.raw);
  EXPECT_NEAR(stereo.rectified.baseline, 0.12, 1e-12);
  // The right camera is where the rectified axes and the baseline put it.
  const Eigen::Vector3d right_centre = stereo.raw->T_right_left.inverse().translation();
  EXPECT_TRUE((R_left * right_centre).isApprox(Eigen::Vector3d(0.12, 0, 0), 1e-12));
  EXPECT_FALSE(stereo_of(info_of(camera, R_left, 0), info_of(camera, R_right, -60), true).raw);
}

TEST(StereoMessages, GiveTheLensThatTheirModelNames) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  RosCameraInfo left = info_of({300, 300, 318, 243, {}}, I, 0);
  RosCameraInfo right = info_of({300, 300, 318, 243, {}}, I, -60);
  left.distortion_model = right.distortion_model = "equidistant";
  left.d = {0.01, 0.02, -0.01, 0.001};
  right.d = {0, 0, 0, 0};
  const auto wide = stereo_of(left, right, false).raw;
  ASSERT_TRUE(wide);
  EXPECT_EQ(wide->left.distortion.lens, Lens::equidistant);
  EXPECT_EQ(wide->left.distortion.k4, 0.001);
  EXPECT_EQ(wide->right.distortion.lens, Lens::equidistant);
  left.distortion_model = right.distortion_model = "rational_polynomial";
  left.d = {0.3, 0.1, 0, 0, 0.01, 0.6, 0.2, 0.02};
  const auto rational = stereo_of(left, right, false).raw;
  ASSERT_TRUE(rational);
  EXPECT_EQ(rational->left.distortion.lens, Lens::radial_tangential);
  EXPECT_EQ(rational->left.distortion.k6, 0.02);
}

TEST(StereoMessages, AreRefusedWithTheReason) {
  const CameraModel camera{510, 512, 318, 243, {-0.3, 0.1, 0.001, -0.002, 0.0}};
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const auto refused = [](const RosCameraInfo& left, const RosCameraInfo& right) {
    try {
      stereo_of(left, right, false);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const RosCameraInfo left = info_of(camera, I, 0), right = info_of(camera, I, -60);
  EXPECT_EQ(refused(left, right), "");
  EXPECT_THAT(refused(left, left), HasSubstr("not calibrated as a pair"));
  EXPECT_THAT(refused(RosCameraInfo(), right), HasSubstr("not calibrated"));
  RosCameraInfo fisheye = right;
  fisheye.distortion_model = "omnidirectional";
  EXPECT_THAT(refused(left, fisheye), HasSubstr("'omnidirectional'"));
  RosCameraInfo prism = right;
  prism.distortion_model = "rational_polynomial";
  prism.d = {0.1, 0, 0, 0, 0, 0, 0, 0, 0.001, 0, 0, 0};
  EXPECT_THAT(refused(left, prism), HasSubstr("of 12 coefficients"));
  RosCameraInfo small = right;
  small.width = 320;
  EXPECT_THAT(refused(left, small), HasSubstr("different sizes"));
}

}  // namespace
}  // namespace maploop::sensors
