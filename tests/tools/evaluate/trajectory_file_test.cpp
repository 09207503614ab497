#include "tools/evaluate/trajectory_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "tests/support/real_data.h"
#include "tools/evaluate/evaluation.h"
#include "tools/evaluate/motion_chain.h"

namespace maploop::evaluation {
namespace {

class TrajectoryFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(folder_.path() / "t.txt") << text;
    return folder_.path() / "t.txt";
  }
  std::string error(const std::string& text) const {
    try {
      read_trajectory(write(text));
      return "";
    } catch (const std::runtime_error& e) {
      return e.what();
    }
  }
  maploop::testing::TemporaryFolder folder_;
};

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
  write_tum(folder_.path() / "t.txt", written);
  const StampedTrajectory read = read_trajectory(folder_.path() / "t.txt");
  EXPECT_EQ(read.stamps, written.stamps);
  ASSERT_EQ(read.poses.size(), written.poses.size());
  for (std::size_t i = 0; i < read.poses.size(); ++i)
    EXPECT_TRUE(read.poses[i].isApprox(written.poses[i], 1e-7)) << i;
}

TEST_F(TrajectoryFile, RecordedTruthIsReadByTheNamesOfItsColumns) {
  const auto t = read_trajectory(
      write("t,cam_qw,cam_qx,cam_qy,cam_qz,cam_x,cam_y,cam_z\n0.5,1,0,0,0,1,2,3\n"));
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
  EXPECT_NE(error(good + "2.0 0 0 0\n").find("t.txt:2: this line has 4 fields"), std::string::npos);
  EXPECT_NE(error(good + "2.0 0 nan 0 0 0 0 1\n").find("t.txt:2: 'nan'"), std::string::npos);
  EXPECT_NE(error(good + "2.0 0 0 0 0 0 0 2\n").find("length one"), std::string::npos);
  EXPECT_NE(error(good + good).find("t.txt:2: its stamp"), std::string::npos);
  EXPECT_NE(error("# nothing\n").find("holds no pose"), std::string::npos);
  EXPECT_NE(error("t,cam_x\n1,2\n").find("no column 'cam_y'"), std::string::npos);
}

TEST_F(TrajectoryFile, ACutCompressedFileIsNamed) {
  const std::filesystem::path file = folder_.path() / "p.gz";
  write_tum(folder_.path() / "t.txt", bend());
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

}  // namespace
}  // namespace maploop::evaluation
