// Tests trajectories in files, and scores of one against another.
#include "tools/evaluate/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "msgs/frames.h"
#include "msgs/local_frame.h"
#include "tests/support/real_data.h"
#include "tests/tools/refusal.h"
#include "tools/evaluate/evaluation.h"
#include "tools/evaluate/motion_chain.h"

namespace maploop::evaluation {
namespace {

using maploop::testing::refusal;
using ::testing::AllOf;
using ::testing::HasSubstr;

class File : public ::testing::Test {
 protected:
  std::filesystem::path file_with(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }
  maploop::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "t.txt";
};
using TrajectoryFile = File;

StampedTrajectory bend() {
  StampedTrajectory t;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 200; ++i) {
    t.stamps.push_back(from_nanoseconds(1'317'042'651'123'456'789 + 100'000'000LL * i));
    t.poses.push_back(pose);
    pose = pose * Eigen::Translation3d(0.0, 0.01, 1.0) *
           Eigen::Isometry3d(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY()));
  }
  return t;
}

TEST_F(TrajectoryFile, TumKeepsNanosecondsAndPoses) {
  const StampedTrajectory written = bend();
  write_tum(file_, written);
  const StampedTrajectory read = read_trajectory(file_);
  EXPECT_EQ(read.stamps, written.stamps);
  ASSERT_EQ(read.poses.size(), written.poses.size());
  for (std::size_t i = 0; i < read.poses.size(); ++i)
    EXPECT_TRUE(read.poses[i].isApprox(written.poses[i], 1e-7)) << i;
}

TEST_F(TrajectoryFile, RecordedTruthIsReadByTheNamesOfItsColumns) {
  const auto t = read_trajectory(
      file_with("t,cam_qw,cam_qx,cam_qy,cam_qz,cam_x,cam_y,cam_z\n0.5,1,0,0,0,1,2,3\n"));
  EXPECT_EQ(t.stamps.front(), Time(from_seconds(0.5)));
  EXPECT_EQ(t.poses.front().translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST_F(TrajectoryFile, KittiPosesHaveNoStampsAndMayBeCompressed) {
  const std::filesystem::path file = folder_.path() / "p.txt.gz";
  const gzFile out = gzopen(file.c_str(), "wb");
  gzputs(out, "1 0 0 5 0 1 0 6 0 0 1 7\n");
  gzclose(out);
  const auto t = read_trajectory(file);
  EXPECT_TRUE(t.stamps.empty());
  EXPECT_EQ(t.poses.front().translation(), Eigen::Vector3d(5.0, 6.0, 7.0));
}

TEST_F(TrajectoryFile, SaysFileAndLineOfWhatItCannotRead) {
  const std::string good = "1.0 0 0 0 0 0 0 1\n";
  for (const auto& [text, said] : std::initializer_list<std::pair<std::string, const char*>>{
           {good + "2.0 0 0 0\n", "t.txt:2: this line has 4 fields"},
           {good + "2.0 0 nan 0 0 0 0 1\n", "t.txt:2: 'nan'"},
           {good + "2.0 0 0 0 0 0 0 2\n", "length one"},
           {good + good, "t.txt:2: its stamp"},
           {"# nothing\n", "holds no pose"},
           {"t,cam_x\n1,2\n", "no column 'cam_y'"}}) {
    EXPECT_THAT(refusal([&, &content = text] { read_trajectory(file_with(content)); }),
                HasSubstr(said));
  }
}

TEST_F(TrajectoryFile, ACutCompressedFileIsNamed) {
  const std::filesystem::path file = folder_.path() / "p.gz";
  {
    const gzFile out = gzopen(file.c_str(), "wb");
    for (int i = 0; i < 500; ++i) gzprintf(out, "1 0 0 %d 0 1 0 6 0 0 1 7\n", i * i);
    gzclose(out);
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_THROW(read_trajectory(file), std::runtime_error);
}

TEST(Match, PairsPosesByTheirStampsAndLeavesTheOthersOut) {
  const StampedTrajectory truth = bend();
  StampedTrajectory estimate;
  for (std::size_t i = 10; i < 50; i += 3) {
    estimate.stamps.push_back(truth.stamps[i] + std::chrono::milliseconds(2));
    estimate.poses.push_back(truth.poses[i]);
  }
  estimate.stamps.push_back(truth.stamps.back() + std::chrono::seconds(1));
  estimate.poses.push_back(truth.poses.back());
  const Matched matched = match(estimate, truth, std::chrono::milliseconds(5));
  ASSERT_EQ(matched.truth.size(), 14u);
  for (std::size_t i = 0; i < matched.truth.size(); ++i)
    EXPECT_TRUE(matched.truth[i].isApprox(matched.estimate[i]));
  EXPECT_EQ(matched.unmatched_estimate, estimate.poses.size() - 14u);
  EXPECT_EQ(matched.unmatched_truth, truth.poses.size() - 14u);
  EXPECT_TRUE(match(estimate, truth, std::chrono::milliseconds(1)).truth.empty());
}

const std::string identity_rows = "1 0 0 0 0 1 0 0 0 0 1 0\n";

class KittiPoses : public File {
 protected:
  void expect_error(const std::string& text, const std::string& where, const std::string& what) {
    EXPECT_THAT(refusal([&] { read_kitti_poses(file_with(text)); }),
                AllOf(HasSubstr(file_.string()), HasSubstr(where), HasSubstr(what)));
  }
};

TEST_F(KittiPoses, ReadsRowByRow) {
  const Trajectory poses = read_kitti_poses(file_with("0 -1 0 1.5e+00 1 0 0 -2 0 0 1 3\r\n\n" +
                                                      identity_rows));  // a quarter turn, with CRLF
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
  expect_error(identity_rows + "1 0 0\n", ":2:", "this line has 3");
  expect_error("0.0 1 2 3 0 0 0 1\n", ":1:", "this line has 8");  // a TUM file
  expect_error("0 " + identity_rows, ":1:", "this line has 13");  // with a frame number
  expect_error("\n" + identity_rows + "1 0 0 0 0 1x 0 0 0 0 1 0\n", ":3:", "'1x'");
  expect_error("1 0 0 nan 0 1 0 0 0 0 1 0\n", ":1:", "'nan'");
  expect_error("1 0 0 1e999 0 1 0 0 0 0 1 0\n", ":1:", "'1e999'");
  expect_error("2 0 0 0 0 2 0 0 0 0 2 0\n", ":1:", "rotation");   // a scaled camera
  expect_error("1 0 0 0 0 1 0 0 0 0 -1 0\n", ":1:", "rotation");  // a mirror
  expect_error("\n \n", "", "no pose");
}

TEST_F(KittiPoses, MissingFileAndFolder) {
  EXPECT_THAT(refusal([&] { read_kitti_poses(folder_.path() / "none.txt"); }),
              HasSubstr("none.txt"));
  EXPECT_THAT(refusal([&] { read_kitti_poses(folder_.path()); }),
              HasSubstr(folder_.path().string()));
  const Trajectory one{Eigen::Isometry3d::Identity()};
  EXPECT_THAT(refusal([&] { write_kitti_poses(folder_.path() / "none" / "poses.txt", one); }),
              HasSubstr("none/poses.txt"));
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

TEST(Evaluate, AScaleErrorOfOnePercentIsOnePercentAtEveryLength) {
  const StampedTrajectory truth = bend();
  StampedTrajectory estimate = truth;
  for (auto& pose : estimate.poses) pose.translation() *= 1.01;
  const Evaluation e = evaluate(match(estimate, truth, Duration(0)), {10.0, 50.0, 100.0, 500.0});
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(e.lengths[i].raw.percent, 1.0, 0.15) << e.lengths[i].length_m;
  EXPECT_EQ(e.lengths[3].raw.segments, 0);
  EXPECT_NEAR(e.rpe_m.mean, 0.01, 1e-3);
  EXPECT_NEAR(e.rpe_deg.max, 0.0, 1e-5);
  EXPECT_NE(to_text(e).find("200 poses"), std::string::npos);
  const std::string page = to_html(e, "a < b");
  EXPECT_NE(page.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(page.substr(0, page.find("<script")).find("nan"), std::string::npos);
}

TEST(Evaluate, PosesWithoutAPartnerAreSaid) {
  StampedTrajectory truth = bend();
  const auto text = [&](const StampedTrajectory& estimate) {
    return to_text(evaluate(match(estimate, truth, Duration(0)), {100.0}));
  };
  EXPECT_EQ(text(truth).find("for want of a partner"), std::string::npos);
  truth.stamps.clear();
  StampedTrajectory estimate = truth;
  estimate.poses.resize(150);
  EXPECT_NE(text(estimate).find("for want of a partner: 0 poses of the estimate, 50 of the truth"),
            std::string::npos);
}

TEST(Evaluate, AlignmentTakesAwayAnyRigidMotion) {
  const StampedTrajectory truth = bend();
  StampedTrajectory estimate = truth;
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(5.0, -3.0, 2.0) *
      Eigen::Isometry3d(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  for (auto& pose : estimate.poses) pose = moved * pose;
  const Evaluation e = evaluate(match(estimate, truth, Duration(0)), {100.0});
  EXPECT_LT(e.ape.max, 1e-9);
  EXPECT_LT(e.raw.end_point_m, 1e-9);
}

TEST(MotionChain, TheTimeBetweenTwoMotionsIsDrivenAsTheSecond) {
  MotionChain chain;
  RelativeMotion motion;
  motion.status = OdometryStatus::first_frame;
  chain.add(motion);
  motion.status = OdometryStatus::ok;
  motion.rotation = Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitZ());
  for (int i = 1; i <= 10; ++i) {  // a scan each 0.1 s takes 60 ms
    motion.from = Time(std::chrono::milliseconds(100 * i - 60));
    motion.stamp = Time(std::chrono::milliseconds(100 * i));
    const Eigen::AngleAxisd turned(chain.add(motion).linear());
    EXPECT_NEAR(turned.angle(), 0.1 * i, 1e-9);
  }
}

TEST(MotionChain, AMotionThatSpansARefusedOneTakesItsPlace) {
  MotionChain chain;
  RelativeMotion motion;
  const auto step = [&](int from, int to, OdometryStatus status) {
    motion.from = Time(from_seconds(from));
    motion.stamp = Time(from_seconds(to));
    motion.status = status;
    motion.translation = {10.0 * (to - from), 0.0, 0.0};
    return chain.add(motion).translation().x();
  };
  EXPECT_EQ(step(0, 0, OdometryStatus::first_frame), 0.0);
  EXPECT_EQ(step(0, 1, OdometryStatus::ok), 10.0);
  EXPECT_EQ(step(1, 2, OdometryStatus::too_few_inliers), 20.0) << "as it went";
  EXPECT_EQ(step(1, 3, OdometryStatus::ok), 30.0) << "from 1, not from what was assumed at 2";
}

// The projection of KITTI's devkit (raw data development kit, latlonToMercator.m).
Eigen::Vector3d mercator(const Geodetic& origin, const Geodetic& at) {
  constexpr double radius = 6378137.0;
  const double scale = std::cos(origin.latitude);
  const auto north = [&](double latitude) {
    return scale * radius * std::log(std::tan(M_PI / 4.0 + latitude / 2.0));
  };
  return {scale * radius * (at.longitude - origin.longitude),
          north(at.latitude) - north(origin.latitude), at.height - origin.height};
}

TEST(KittiMercator, PosesComeBackInMetresWhicheverWayTheFirstCameraLooks) {
  const Geodetic origin{radians(49.03), radians(8.39), 110.0};
  const LocalFrame frame(origin);
  for (const double azimuth : {0.0, 0.7, 2.0, -2.5}) {
    Eigen::Matrix3d R_enu_cam;  // columns: right, down, ahead
    R_enu_cam << std::cos(azimuth), 0.0, std::sin(azimuth), -std::sin(azimuth), 0.0,
        std::cos(azimuth), 0.0, -1.0, 0.0;
    Trajectory published, truth;
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(400, 0, 2), Eigen::Vector3d(400, -300, 0)}) {
      truth.emplace_back(Eigen::Translation3d(R_enu_cam.transpose() * p));
      published.emplace_back(
          Eigen::Translation3d(R_enu_cam.transpose() * mercator(origin, frame.to_geodetic(p))));
    }
    const Trajectory metric = from_kitti_mercator(published, origin.latitude, azimuth);
    EXPECT_GT((published[1].translation() - truth[1].translation()).norm(), 0.5);
    for (std::size_t i = 0; i < truth.size(); ++i)  // over 400 m the Earth's curvature is 1 cm up
      EXPECT_LT((metric[i].translation() - truth[i].translation()).norm(), 0.04) << i;
  }
}

}  // namespace
}  // namespace maploop::evaluation
