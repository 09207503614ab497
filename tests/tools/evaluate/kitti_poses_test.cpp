#include "tools/evaluate/kitti_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/support/real_data.h"

namespace maploop::evaluation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

class KittiPoses : public ::testing::Test {
 protected:
  std::filesystem::path file_with(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }
  void expect_error(const std::string& text, const std::string& where, const std::string& what) {
    EXPECT_THAT([&] { read_kitti_poses(file_with(text)); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr(file_.string()), HasSubstr(where), HasSubstr(what))));
  }

  maploop::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "poses.txt";
};

TEST_F(KittiPoses, ReadsRowByRow) {
  const Trajectory poses = read_kitti_poses(
      file_with("0 -1 0 1.5e+00 1 0 0 -2 0 0 1 3\r\n\n" + kIdentity));  // a quarter turn, with CRLF
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation(), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(poses[0] * Eigen::Vector3d::UnitX(), Eigen::Vector3d(1.5, -1, 3));
  EXPECT_TRUE(poses[1].matrix().isIdentity(0.0));
}

TEST_F(KittiPoses, WrittenPosesComeBackBitForBit) {
  Trajectory poses;
  for (int i = 0; i < 20; ++i) {
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(1, 2, 3).normalized()));
    pose.translation() = Eigen::Vector3d(1.0 / 3.0, -1e-9 * i, 1e6 / 7.0);
    poses.push_back(pose);
  }
  write_kitti_poses(file_, poses);
  const Trajectory back = read_kitti_poses(file_);
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(back[i].matrix(), poses[i].matrix());
}

TEST_F(KittiPoses, ErrorsNameFileAndLine) {
  expect_error(kIdentity + "1 0 0\n", ":2:", "this line has 3");
  expect_error("0.0 1 2 3 0 0 0 1\n", ":1:", "this line has 8");  // a TUM file
  expect_error("0 " + kIdentity, ":1:", "this line has 13");      // with a frame number
  expect_error("\n" + kIdentity + "1 0 0 0 0 1x 0 0 0 0 1 0\n", ":3:", "'1x'");
  expect_error("1 0 0 nan 0 1 0 0 0 0 1 0\n", ":1:", "'nan'");
  expect_error("1 0 0 1e999 0 1 0 0 0 0 1 0\n", ":1:", "'1e999'");
  expect_error("2 0 0 0 0 2 0 0 0 0 2 0\n", ":1:", "rotation");   // a scaled camera
  expect_error("1 0 0 0 0 1 0 0 0 0 -1 0\n", ":1:", "rotation");  // a mirror
  expect_error("\n \n", "", "no pose");
}

TEST_F(KittiPoses, MissingFileAndFolder) {
  EXPECT_THAT([&] { read_kitti_poses(folder_.path() / "none.txt"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("none.txt")));
  EXPECT_THAT([&] { read_kitti_poses(folder_.path()); },
              ThrowsMessage<std::runtime_error>(HasSubstr(folder_.path().string())));
  const Trajectory one{Eigen::Isometry3d::Identity()};
  EXPECT_THAT([&] { write_kitti_poses(folder_.path() / "none" / "poses.txt", one); },
              ThrowsMessage<std::runtime_error>(HasSubstr("none/poses.txt")));
}

TEST_F(KittiPoses, FullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "SKIPPED, NOT TESTED: no /dev/full";
  EXPECT_THROW(write_kitti_poses("/dev/full", {Eigen::Isometry3d::Identity()}), std::runtime_error);
}

TEST_F(KittiPoses, PoseThatIsNotFiniteIsNotWritten) {
  Trajectory poses(2, Eigen::Isometry3d::Identity());
  poses[1].translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { write_kitti_poses(file_, poses); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("pose 1")));
  EXPECT_FALSE(std::filesystem::exists(file_));
}

}  // namespace
}  // namespace maploop::evaluation
