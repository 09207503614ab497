#include "runtime/vehicle/drivers/stereo_rig_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Returns parallel cameras half a metre apart, with different lenses.
sensors::StereoRig rig() {
  sensors::StereoRig r;
  r.width = 640;
  r.height = 480;
  r.left = {500.0, 501.0, 320.0, 241.0, {-0.1, 0.01, 0.001, -0.0005, 1.0 / 3.0 * 0.001}};
  r.right = {502.0, 503.0, 318.0, 239.0, {-0.11, 0.012, 0.0, 0.0002, 0.0}};
  r.T_right_left.translation() << -0.5, 0.0, 0.0;
  r.rectified = {640, 480, 510.0, 510.0, 319.5, 239.5, 0.5, Eigen::Isometry3d::Identity()};
  return r;
}

sensors::StereoRig read(const std::string& text, const char* name = "rig.toml") {
  const maploop::testing::TemporaryFolder folder;
  const auto file = folder.path() / name;
  std::ofstream(file) << text;
  return read_stereo_rig(file);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(StereoRigFile, WhatIsWrittenIsReadBackBitForBit) {
  const sensors::StereoRig written = rig();
  EXPECT_EQ(to_toml(read(to_toml(written))), to_toml(written));
  EXPECT_EQ(to_toml(read(to_toml(written, {{"left.fx", "sigma 0.1 px"}}))), to_toml(written));
}

TEST(StereoRigFile, OtherLensesAreReadBackBitForBit) {
  sensors::StereoRig wide = rig();
  wide.left.distortion = {.k1 = 0.01, .k4 = 0.001, .lens = sensors::Lens::equidistant};
  wide.right.distortion = {.k1 = 0.1, .k4 = 0.3, .k5 = 0.02, .k6 = 0.004};
  const std::string text = to_toml(wide);
  EXPECT_EQ(to_toml(read(text)), text);
  EXPECT_EQ(read(text).left.distortion.lens, sensors::Lens::equidistant);
  EXPECT_EQ(read(text).right.distortion.k6, 0.004);
}

TEST(StereoRigFile, EveryErrorNamesTheKey) {
  const std::string good = to_toml(rig());
  const std::pair<std::string, std::string> wrong[] = {
      {replaced(good, "k2 = ", "kk = "), "k2"},
      {replaced(good, "fx = 500", "fx = \"wide\""), "left.fx"},
      {replaced(good, "[extrinsics]", "[extrinsic]"), "R_right_left"},
      {replaced(good, "R_right_left = [1", "R_right_left = [3"), "R_right_left"},
      {replaced(good, "R_right_left = [1", "R_right_left = [-1"), "mirrored"},
      {replaced(good, "t_right_left = [-0.5", "t_right_left = [0.5"), "does not fit"},
      {replaced(good, "baseline = 0.5", "baseline = 0.6"), "does not fit"},
      {replaced(good, "fx = 500", "fx = -500"), "focal length"},
      {replaced(good, "undistorted_to_distorted", "sideways"), "direction"},
      {replaced(good, "direction =", "lens = \"wide\"\ndirection ="), "lens"},
      {replaced(replaced(good, "undistorted_to_distorted", "distorted_to_undistorted"),
                "direction =", "k5 = 0.1\ndirection ="),
       "without k4, k5 and k6"},
      {good + "\n[quality]\nviews = 3\n", "quality"},
  };
  for (const auto& [text, said] : wrong) {
    EXPECT_THAT(error_of([&, &text = text] { read(text); }),
                AllOf(HasSubstr(said), HasSubstr("rig.toml")));
  }
}

TEST(StereoRigFile, CoefficientsOfTheOtherDirectionAreConverted) {
  const sensors::StereoRig there = rig();
  const auto back = sensors::reversed(there.left, there.width, there.height);
  sensors::StereoRig turned = there;
  turned.left.distortion = back.distortion;
  const sensors::StereoRig again =
      read(replaced(to_toml(turned), "undistorted_to_distorted", "distorted_to_undistorted"));
  const Eigen::Vector2d ray(0.4, -0.3);
  EXPECT_LT((*project(again.left, ray) - *project(there.left, ray)).norm(), 0.1);
  EXPECT_LT(again.left.distortion.k1, 0.0);
}

TEST(StereoRigFile, ReadsKittisOwnCalibration) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const sensors::StereoRig kitti =
      read_stereo_rig(maploop::testing::real_data() / "kitti/2011_09_26/calib_cam_to_cam.txt");
  EXPECT_EQ(kitti.width, 1392);
  EXPECT_EQ(kitti.rectified.width, 1242);
  EXPECT_NEAR(kitti.rectified.baseline, 0.5372, 1e-4);
  EXPECT_NEAR(kitti.right.distortion.k3, -0.05314062, 1e-9);
  EXPECT_THROW(read("S_00: 1 2\n", "calib_cam_to_cam.txt"), std::runtime_error);
}

}  // namespace
}  // namespace maploop::vehicle
