// These tests find the mount of units whose true mount is known.
#include "sensors/imu/mount_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;
constexpr Duration step = std::chrono::milliseconds(10);

Time at(double seconds) {
  return Time(std::chrono::hours(300'000)) + from_seconds(seconds);
}

Matrix3d rotation(double roll, double pitch, double yaw) {  // deg
  return (Eigen::AngleAxisd(radians(yaw), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(radians(pitch), Vector3d::UnitY()) *
          Eigen::AngleAxisd(radians(roll), Vector3d::UnitX()))
      .toRotationMatrix();
}

double angle_between(const Matrix3d& a, const Matrix3d& b) {  // deg
  return degrees(Eigen::AngleAxisd(a * b.transpose()).angle());
}

// A car that stands, drives off, and goes on with turns and changes of its speed.
struct MadeDrive {
  Matrix3d R_body_unit = Matrix3d::Identity();
  Vector3d gyro_bias = Vector3d::Zero(), force_bias = Vector3d::Zero();
  double force_scale = 1.0;
  double standing = 5.0;     // s
  double ahead = 0.0;        // m, of the unit and the antenna before the rear axle
  double turning = 1.0;      // times the turns of a town
  double changes = 1.0;      // times its changes of speed
  double wrong_share = 0.0;  // of the fixes, with a velocity that is off by 20 m/s
  bool every_other = false;  // fix has no velocity, as where it comes from positions of the second

  double speed(double t) const {
    const double s = t - standing;
    if (s < 0.0) return 0.0;
    return std::min(2.0 * s, 9.0 + changes * 4.0 * std::sin(0.25 * s));
  }
  double rate(double t) const {
    return t < standing ? 0.0 : turning * 0.25 * std::sin(0.4 * (t - standing));
  }
  SixAxisSample sample(double t) const {
    constexpr double h = 1e-4;
    const double acceleration = (speed(t + h) - speed(t - h)) / (2.0 * h);
    SixAxisSample result;
    result.stamp = result.available = at(t);
    const Vector3d force(acceleration, speed(t) * rate(t), gravity);
    result.force = force_scale * (R_body_unit.transpose() * force) + force_bias;
    result.rate = R_body_unit.transpose() * Vector3d(0.0, 0.0, rate(t)) + gyro_bias;
    return result;
  }
  GnssFix fix(double t, double yaw) const {
    const double sideways = ahead * rate(t);
    GnssFix result;
    result.stamp = result.available = result.velocity_stamp = at(t);
    result.velocity_enu = Vector3d(speed(t) * std::cos(yaw) - sideways * std::sin(yaw),
                                   speed(t) * std::sin(yaw) + sideways * std::cos(yaw), 0.0);
    result.velocity_covariance = 0.01 * Matrix3d::Identity();
    constexpr double golden = 0.618034;  // spreads the wrong ones
    if (std::fmod(2.0 * t * golden, 1.0) < wrong_share) result.velocity_enu.x() += 20.0;
    if (every_other && std::fmod(t, 1.0) > 0.25) {
      result.velocity_enu.setZero();
      result.velocity_covariance = 1e4 * Matrix3d::Identity();
    }
    return result;
  }
};

// Shows the alignment `seconds` of the drive; a fix each half second.
void drive(MountAlignment& alignment, const MadeDrive& car, double seconds) {
  double yaw = 0.7;
  for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
    const double t = 0.01 * i;
    if (i % 50 == 0) alignment.add(car.fix(t, yaw));
    alignment.add(car.sample(t));
    yaw += 0.01 * car.rate(t + 0.005);
  }
}

Mount mount_after(const MadeDrive& car, double seconds, double ahead = 0.0) {
  MountAlignment alignment({}, ahead);
  drive(alignment, car, seconds);
  return alignment.mount();
}

TEST(MountAlignment, IsFoundInEveryOctantAndAlongTheAxes) {
  for (const double roll : {-130.0, -50.0, 0.0, 50.0, 90.0, 130.0, 180.0}) {
    for (const double pitch : {-86.0, -40.0, 0.0, 40.0, 90.0}) {
      for (const double yaw : {-130.0, -50.0, 0.0, 50.0, 90.0, 130.0, 180.0}) {
        MadeDrive car;
        car.R_body_unit = rotation(roll, pitch, yaw);
        const Mount mount = mount_after(car, 40.0);
        EXPECT_EQ(mount.status, MountStatus::found);
        EXPECT_LT(angle_between(mount.R_body_unit, car.R_body_unit), 0.3)
            << roll << ' ' << pitch << ' ' << yaw;
      }
    }
  }
}

TEST(MountAlignment, FixesWithoutAVelocityAreNoRestAndInterruptNothing) {
  MadeDrive car;
  car.R_body_unit = rotation(40.0, -40.0, 130.0);
  car.gyro_bias = {0.005, -0.009, 0.006};
  car.every_other = true;
  const Mount mount = mount_after(car, 60.0);
  EXPECT_EQ(mount.status, MountStatus::found);
  EXPECT_LT(angle_between(mount.R_body_unit, car.R_body_unit), 0.5);
}

TEST(MountAlignment, ReducedSamplesAreThoseOfAUnitAlongTheBody) {
  MadeDrive car;
  car.R_body_unit = rotation(-86.0, 76.0, 184.0);
  car.gyro_bias = {0.005, -0.009, 0.006};
  MountAlignment alignment{{}};
  drive(alignment, car, 60.0);
  const ImuSample reduced = alignment.aligned(car.sample(60.0));
  MadeDrive along;
  const SixAxisSample truth = along.sample(60.0);
  EXPECT_EQ(reduced.stamp, truth.stamp);
  EXPECT_NEAR(reduced.specific_force_forward, truth.force.x(), 0.03);
  EXPECT_NEAR(reduced.specific_force_left, truth.force.y(), 0.03);
  EXPECT_NEAR(reduced.yaw_rate, truth.rate.z(), 1e-3);
}

TEST(MountAlignment, TheGyrosBiasIsFoundAtRestAndInMotion) {
  for (const double standing : {5.0, 0.0}) {
    MadeDrive car;
    car.standing = standing;
    car.R_body_unit = rotation(171.0, 61.0, 168.0);
    car.gyro_bias = {0.005, -0.009, 0.006};
    const Mount mount = mount_after(car, 60.0);
    const Vector3d up = mount.R_body_unit.row(2).transpose();
    EXPECT_NEAR(up.dot(mount.gyro_bias), up.dot(car.gyro_bias), standing > 0.0 ? 1e-6 : 2e-3);
    if (standing > 0.0) {
      EXPECT_LT((mount.gyro_bias - car.gyro_bias).norm(), 1e-6);
    }
  }
}

TEST(MountAlignment, AConstantBiasAndAScaleAreSmallTilts) {
  MadeDrive car;
  car.R_body_unit = rotation(-2.0, 0.0, 263.0);
  car.force_scale = 1.03;
  car.force_bias = {0.2, -0.15, 0.3};
  const Mount mount = mount_after(car, 60.0);
  EXPECT_EQ(mount.status, MountStatus::found);
  EXPECT_LT(angle_between(mount.R_body_unit, car.R_body_unit), degrees(0.25 / gravity) + 0.3);
  MountAlignment alignment{{}};
  drive(alignment, car, 60.0);
  const ImuSample standing = alignment.aligned(car.sample(0.0));
  EXPECT_NEAR(standing.specific_force_forward, 0.0, 0.05);  // the tilt takes the bias away
  EXPECT_NEAR(standing.specific_force_left, 0.0, 0.05);
}

TEST(MountAlignment, TheGyrosShowTheVerticalThatABiasTilts) {
  MadeDrive car;
  car.R_body_unit = rotation(-2.0, 3.0, 263.0);
  car.force_bias = {0.3, -0.3, 0.0};
  car.gyro_bias = {0.005, -0.009, 0.006};
  const Mount mount = mount_after(car, 60.0);
  const Vector3d up = car.R_body_unit.row(2).transpose();
  const auto angle_to_up = [&](const Vector3d& v) {
    return degrees(v.cross(up).norm() / v.norm());
  };
  EXPECT_GT(angle_to_up(mount.R_body_unit.row(2).transpose()), 2.0);
  EXPECT_LT(angle_to_up(mount.turning.axis), 0.05);
  EXPECT_NEAR(mount.turning.axis.norm(), 1.0, 0.02);
  EXPECT_LT(mount.turning.sigma, radians(0.1));
}

TEST(MountAlignment, AStraightRoadShowsNoVerticalByTheGyros) {
  MadeDrive car;
  car.turning = 0.0;
  EXPECT_GT(mount_after(car, 60.0).turning.sigma, 3.0);
}

TEST(MountAlignment, WrongVelocitiesDoNotTurnIt) {
  MadeDrive car;
  car.R_body_unit = rotation(10.0, -20.0, 100.0);
  car.wrong_share = 0.1;
  const Mount mount = mount_after(car, 120.0);
  EXPECT_EQ(mount.status, MountStatus::found);
  EXPECT_LT(angle_between(mount.R_body_unit, car.R_body_unit), 0.5);
}

TEST(MountAlignment, TheAntennasCourseIsCorrectedByTheRearAxle) {
  MadeDrive car;
  car.ahead = 2.0;
  car.R_body_unit = rotation(0.0, 0.0, 30.0);
  const double corrected = angle_between(mount_after(car, 60.0, 2.0).R_body_unit, car.R_body_unit);
  EXPECT_LT(corrected, 0.5);
}

// Neither shows where forward is.
TEST(MountAlignment, IsNotFoundAtRestOrOnAStraightRoadAtOneSpeed) {
  MadeDrive standing;
  standing.standing = 1000.0;
  EXPECT_FALSE(mount_after(standing, 120.0).known());
  MadeDrive straight;
  straight.turning = straight.changes = 0.0;
  straight.standing = -10.0;  // it is at its speed already
  EXPECT_FALSE(mount_after(straight, 120.0).known());
}

TEST(MountAlignment, AGivenMountIsKnownAtOnceAndKept) {
  MadeDrive car;
  MountAlignment alignment({true, 90.0, 0.0, 0.0});
  EXPECT_EQ(alignment.mount().status, MountStatus::given);
  Matrix3d by_hand;
  by_hand << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // the unit's y points up, its z to the right
  EXPECT_LT((alignment.mount().R_body_unit - by_hand).norm(), 1e-12);
  drive(alignment, car, 60.0);
  EXPECT_LT((alignment.mount().R_body_unit - by_hand).norm(), 1e-12);
}

TEST(MountAlignment, AFixThatComesLateCountsTheSame) {
  MadeDrive car;
  car.R_body_unit = rotation(0.0, 30.0, 60.0);
  MountAlignment timely{{}}, late{{}};
  std::vector<GnssFix> waiting;
  double yaw = 0.7;
  for (int i = 0; i < 4000; ++i) {
    const double t = 0.01 * i;
    if (i % 50 == 0) {
      timely.add(car.fix(t, yaw));
      waiting.push_back(car.fix(t, yaw));
    }
    timely.add(car.sample(t));
    late.add(car.sample(t));
    if (i % 50 == 20) late.add(waiting.back());
    yaw += 0.01 * car.rate(t + 0.005);
  }
  EXPECT_TRUE(late.mount().known());
  EXPECT_EQ(late.mount().R_body_unit, timely.mount().R_body_unit);
}

TEST(MountAlignment, NothingIsLearntAcrossAGapOrFromNumbersThatAreNone) {
  MadeDrive car;
  MountAlignment alignment{{}};
  double yaw = 0.7;
  for (int i = 0; i < 12'000; ++i) {
    const double t = 0.01 * i;
    GnssFix fix = car.fix(t, yaw);
    if (i % 100 == 50) fix.velocity_enu.x() = std::nan("");
    if (i % 50 == 0) alignment.add(fix);
    if (i % 50 < 25) alignment.add(car.sample(t));  // there is a gap in each interval
    yaw += 0.01 * car.rate(t + 0.005);
  }
  EXPECT_EQ(alignment.mount().intervals, 0u);
}

}  // namespace
}  // namespace maploop::sensors
