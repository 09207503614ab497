// These tests replace visual odometry by another system's trajectory.
#include "sensors/replay/pose_odometry.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "msgs/frames.h"
#include "sensors/replay/odometry_sequence.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using maploop::testing::real_data;
using ::testing::HasSubstr;

// Returns the error of reading a file with this text.
std::string refusal(const std::string& text) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "poses.txt";
  std::ofstream(file) << text;
  return maploop::testing::error_of([&] { read_camera_poses(file); });
}

const std::string at_rest = "1 0 0 0 0 1 0 0 0 0 1 0\n";

TEST(PoseOdometry, RefusesAnInvalidTrajectoryByFileAndLine) {
  EXPECT_THAT(refusal(""), HasSubstr("fewer than two"));
  EXPECT_THAT(refusal(at_rest + "1 0 0\n"), HasSubstr("poses.txt:2: a pose must have 12"));
  EXPECT_THAT(refusal(at_rest + "1 0 0 0 0 nan 0 0 0 0 1 0\n"), HasSubstr(":2:"));
  EXPECT_THAT(refusal(at_rest + "1 0 0 0 0 2 0 0 0 0 1 0\n"), HasSubstr("no"));
  EXPECT_THAT(refusal("3 " + at_rest + "2 " + at_rest), HasSubstr("frame 2 comes after frame 3"));
  EXPECT_EQ(refusal("0 " + at_rest + "2 " + at_rest), "");
}

TEST(PoseOdometry, MotionsOfTheBodyFollowTheCameras) {
  auto poses = std::make_shared<CameraPoses>();
  poses->frames = {0, 2};
  poses->poses.resize(2, Eigen::Isometry3d::Identity());
  poses->poses[1].translation() << 0.0, 0.0, 3.0;  // the camera looks along its z
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  T_body_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const std::vector<Time> stamps{Time(from_seconds(1.0)), Time(from_seconds(1.1)),
                                 Time(from_seconds(1.2))};
  const auto source = make_pose_odometry(poses, stamps, T_body_cam, {}, from_seconds(0.06));
  RelativeMotion motion;
  ASSERT_TRUE(source->next(motion));
  EXPECT_EQ(motion.status, OdometryStatus::first_frame);
  ASSERT_TRUE(source->next(motion));
  EXPECT_EQ(motion.status, OdometryStatus::ok);
  EXPECT_EQ(motion.from, stamps[0]);
  EXPECT_EQ(motion.stamp, stamps[2]);
  EXPECT_EQ(motion.available, stamps[2] + from_seconds(0.06));
  EXPECT_TRUE(motion.translation.isApprox(Eigen::Vector3d(3.0, 0.0, 0.0)));
  EXPECT_NEAR(std::sqrt(motion.covariance(0, 0)), 0.3 * 0.2, 1e-12);
  EXPECT_FALSE(source->next(motion));
  EXPECT_THROW(make_pose_odometry(poses, {stamps[0]}, T_body_cam, {}, {}), std::runtime_error);
}

TEST(PoseOdometry, ReadsTheTrajectoriesOfOtherSystems) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto peers = real_data() / "kitti_odometry/peers";
  const OdometrySequence sequence(real_data() / "kitti_odometry/oxts/00.csv.gz", {});
  for (const char* name : {"00_ORB_evo.txt.gz", "00_SPTAM_evo.txt.gz"}) {
    const auto poses = std::make_shared<const CameraPoses>(read_camera_poses(peers / name));
    ASSERT_EQ(poses->poses.size(), 4541u) << name;
    const auto source = make_pose_odometry(poses, sequence.image_stamps(),
                                           sequence.calibration().stereo.T_body_cam, {}, {});
    double way = 0.0;
    for (RelativeMotion m; source->next(m);) way += m.translation.norm();
    EXPECT_NEAR(way, 3724.0, 60.0) << name;
  }
}

}  // namespace
}  // namespace maploop::sensors
