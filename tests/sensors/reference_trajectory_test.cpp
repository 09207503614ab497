#include "sensors/replay/reference_trajectory.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "msgs/frames.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/timestamps.h"
#include "tests/sensors/small_drive.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;

const Time start = parse_time("2011-09-26 13:10:51");
const LocalFrame frame(Geodetic{0.855, 0.147, 110.0});

ReferencePose row(int ms, const Eigen::Vector3d& p_enu, double azimuth_degrees) {
  ReferencePose pose;
  pose.stamp = start + milliseconds(ms);
  pose.position = frame.to_geodetic(p_enu);
  pose.attitude = {radians(azimuth_degrees), radians(2.0), radians(-1.0)};
  return pose;
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

const std::vector<ReferencePose> rows{row(0, {0, 0, 0}, 350), row(100, {0, 1, 0.1}, 354),
                                      row(200, {0.1, 2, 0.2}, 4), row(1000, {3, 9, 0.3}, 20),
                                      row(1100, {4, 10, 0.4}, 22)};

TEST(ReferenceTrajectory, GoesThroughItsRows) {
  const ReferenceTrajectory trajectory(rows, frame);
  for (const ReferencePose& r : rows) {
    const auto pose = trajectory.pose(r.stamp);
    ASSERT_TRUE(pose);
    EXPECT_LT((pose->translation() - frame.to_enu(r.position)).norm(), 1e-9);
    EXPECT_LT((pose->linear() - rotation_enu_body(r.attitude)).norm(), 1e-12);
  }
}

TEST(ReferenceTrajectory, InterpolatesAlongTheLineAndTheShorterTurnThroughNorth) {
  const auto pose = ReferenceTrajectory(rows, frame).pose(start + milliseconds(125));
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation() - Eigen::Vector3d(0.025, 1.25, 0.125)).norm(), 1e-7);
  const Attitude expected{radians(356.5), radians(2.0), radians(-1.0)};
  EXPECT_LT(angle_between(pose->linear(), rotation_enu_body(expected)), radians(0.01));
}

TEST(ReferenceTrajectory, CarriesOnForAtMostTwentyMillisecondsBeyondTheEnds) {
  const ReferenceTrajectory trajectory(rows, frame);
  const auto before = trajectory.pose(start - milliseconds(20));
  ASSERT_TRUE(before);
  EXPECT_LT((before->translation() - Eigen::Vector3d(0, -0.2, -0.02)).norm(), 1e-7);
  EXPECT_NEAR(degrees(attitude_from_rotation(before->linear()).azimuth), 349.2 - 360.0, 0.01);
  const auto after = trajectory.pose(start + milliseconds(1120));
  ASSERT_TRUE(after);
  EXPECT_LT((after->translation() - Eigen::Vector3d(4.2, 10.2, 0.42)).norm(), 1e-7);
  EXPECT_FALSE(trajectory.pose(start - milliseconds(21)));
  EXPECT_FALSE(trajectory.pose(start + milliseconds(1121)));
}

TEST(ReferenceTrajectory, HasNothingToSayInsideAGap) {
  const ReferenceTrajectory trajectory(rows, frame);
  EXPECT_FALSE(trajectory.pose(start + milliseconds(600)));
  EXPECT_TRUE(trajectory.pose(start + milliseconds(1000)));
}

TEST(ReferenceTrajectory, IsAsAccurateAsTheWorseOfTheRowsAround) {
  std::vector<ReferencePose> stated = rows;
  for (std::size_t i = 0; i < stated.size(); ++i)
    stated[i].position_accuracy = i == 1 ? 0.9 : 0.1 * static_cast<double>(i);
  const ReferenceTrajectory trajectory(stated, frame);
  EXPECT_EQ(trajectory.accuracy(start), 0.0);
  EXPECT_EQ(trajectory.accuracy(start + milliseconds(50)), 0.9);
  EXPECT_EQ(trajectory.accuracy(start + milliseconds(100)), 0.9);
  EXPECT_EQ(trajectory.accuracy(start + milliseconds(150)), 0.9);
  EXPECT_EQ(trajectory.accuracy(start + milliseconds(200)), 0.2);
  EXPECT_EQ(trajectory.accuracy(start + milliseconds(1120)), 0.4);
}

TEST(ReferenceTrajectory, RefusesRowsOutOfOrderAndTooFew) {
  EXPECT_THROW(ReferenceTrajectory({rows[0]}, frame), std::invalid_argument);
  EXPECT_THROW(ReferenceTrajectory({rows[1], rows[0]}, frame), std::invalid_argument);
  EXPECT_THROW(ReferenceTrajectory({rows[1], rows[1]}, frame), std::invalid_argument);
}

class OnTheDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    drive.emplace(maploop::testing::drive_0013());
    reference = read_all(*drive->reference());
    origin = LocalFrame(reference.front().position);
  }
  std::optional<KittiDrive> drive;
  std::vector<ReferencePose> reference;
  LocalFrame origin;
};

// Every other row is left out and interpolated from its neighbours 200 ms apart.
TEST_F(OnTheDrive, FindsRowsThatWereLeftOut) {
  std::vector<ReferencePose> half;
  for (std::size_t i = 0; i < reference.size(); i += 2) half.push_back(reference[i]);
  const ReferenceTrajectory trajectory(half, origin);
  double position = 0, angle = 0;
  for (std::size_t i = 1; i + 1 < reference.size(); i += 2) {
    const auto pose = trajectory.pose(reference[i].stamp);
    ASSERT_TRUE(pose);
    position =
        std::max(position, (pose->translation() - origin.to_enu(reference[i].position)).norm());
    angle =
        std::max(angle, angle_between(pose->linear(), rotation_enu_body(reference[i].attitude)));
  }
  RecordProperty("largest_position_error", std::to_string(position));
  RecordProperty("largest_angle_degrees", std::to_string(degrees(angle)));
  EXPECT_LT(position, 0.012);
  EXPECT_LT(angle, radians(0.25));
}

// The expected truth was made by other means: OXTS carried to the image stamps by its own velocity
// and rate, in KITTI's spherical Mercator (up to 0.2 % off, 2.5 mm a step).
TEST_F(OnTheDrive, AgreesWithTimeCorrectedTruthAtTheLeftImagesStamps) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const ReferenceTrajectory trajectory(reference, origin);
  std::ifstream file(maploop::testing::real_data() / "kitti/drive_0013_truth/time_corrected.txt");
  const Eigen::Isometry3d& T_body_cam = drive->calibration().stereo.T_body_cam;
  std::optional<Eigen::Isometry3d> last_ours, last_truth;
  double step_m = 0, step_angle = 0;
  int frames = 0;
  const Timestamps left =
      read_timestamps(maploop::testing::drive_0013() / "image_00" / "timestamps.txt");
  for (const Time stamp : left.stamps) {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> printed;
    for (int i = 0; i < 12; ++i) file >> printed.data()[i];
    ASSERT_TRUE(file) << "frame " << frames;
    Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
    truth.matrix().topRows<3>() = printed;
    const auto body = trajectory.pose(stamp);
    ASSERT_TRUE(body) << "frame " << frames;
    const Eigen::Isometry3d ours = *body * T_body_cam;
    if (last_ours) {
      const Eigen::Isometry3d a = last_ours->inverse() * ours, b = last_truth->inverse() * truth;
      step_m = std::max(step_m, (a.translation() - b.translation()).norm());
      step_angle = std::max(step_angle, angle_between(a.linear(), b.linear()));
    }
    last_ours = ours;
    last_truth = truth;
    ++frames;
  }
  RecordProperty("largest_step_error", std::to_string(step_m));
  RecordProperty("largest_step_angle_degrees", std::to_string(degrees(step_angle)));
  EXPECT_EQ(frames, 144);
  EXPECT_LT(step_m, 0.005);
  EXPECT_LT(step_angle, radians(0.025));
}

}  // namespace
}  // namespace maploop::sensors
