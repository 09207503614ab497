// These tests read the real drive 2011_09_26_drive_0013_sync. The expected values were taken from
// its files by other means.
#include "sensors/replay/kitti_drive.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <optional>

#include "msgs/frames.h"
#include "tests/sensors/small_drive.h"

namespace maploop::sensors {
namespace {

using std::chrono::milliseconds;

class RealDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    drive.emplace(maploop::testing::drive_0013());
  }
  std::optional<KittiDrive> drive;
};

std::uint64_t sum(const GreyImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), std::uint64_t{0});
}

template <class T>
void expect_complete(const SourceReport& report, const std::vector<T>& samples) {
  EXPECT_EQ(report.delivered, samples.size());
  EXPECT_EQ(report.refused, 0U);
  EXPECT_EQ(report.flawed, 0U);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_LT(samples[i - 1].stamp, samples[i].stamp);
    EXPECT_LT(samples[i - 1].available, samples[i].available);
    EXPECT_EQ(samples[i].sequence, samples[i - 1].sequence + 1);
  }
}

TEST_F(RealDrive, FramesStampsAndCalibration) {
  EXPECT_EQ(drive->frame_count(), 144U);
  EXPECT_EQ(drive->first_stamp(), parse_time("2011-09-26 13:10:51.174740992"));
  EXPECT_EQ(drive->last_stamp(), parse_time("2011-09-26 13:11:05.983189248"));
  EXPECT_TRUE(drive->has_velodyne());
  EXPECT_TRUE(drive->has_oxts());
  const VehicleCalibration& c = drive->calibration();
  EXPECT_EQ(c.stereo.width, 1242);
  EXPECT_EQ(c.stereo.height, 375);
  EXPECT_DOUBLE_EQ(c.stereo.fx, 721.5377);
  EXPECT_NEAR(c.stereo.baseline, 0.5371506, 1e-7);
  EXPECT_LT(
      (c.stereo.T_body_cam.translation() - Eigen::Vector3d(1.083302, -0.309889, 0.729920)).norm(),
      1e-5);
  EXPECT_LT((c.T_body_velo.translation() - Eigen::Vector3d(0.810544, -0.307054, 0.802724)).norm(),
            1e-5);
}

TEST_F(RealDrive, Camera) {
  auto camera = drive->camera();
  StereoPair pair;
  std::uint64_t count = 0;
  Duration largest_skew{};
  Time last_available{};
  const std::uint8_t* left_buffer = nullptr;
  while (camera->next(pair)) {
    ASSERT_EQ(pair.sequence, count++);
    const Duration skew = pair.available - milliseconds(5) - pair.stamp;
    EXPECT_GE(skew, Duration::zero());
    EXPECT_LT(last_available, pair.available);
    last_available = pair.available;
    largest_skew = std::max(largest_skew, skew);
    if (left_buffer == nullptr) left_buffer = pair.left.pixels.data();
    ASSERT_EQ(pair.left.pixels.data(), left_buffer) << "decoded into another buffer";
    ASSERT_EQ(pair.left.pixels.size(), 1242U * 375U);
    if (pair.sequence == 0) {
      EXPECT_EQ(pair.stamp, parse_time("2011-09-26 13:10:51.174740992"));
      EXPECT_EQ(skew, parse_time("2011-09-26 13:10:51.174921216") - pair.stamp);
      EXPECT_EQ(sum(pair.left), 42799826U);
      EXPECT_EQ(sum(pair.right), 42794095U);
      EXPECT_EQ(pair.left.pixels[200 * 1242 + 600], 44);
      EXPECT_EQ(pair.right.pixels[200 * 1242 + 600], 63);
    } else if (pair.sequence == 143) {
      EXPECT_EQ(sum(pair.left), 55304138U);
      EXPECT_EQ(sum(pair.right), 56104335U);
    }
  }
  EXPECT_EQ(count, 144U);
  EXPECT_GT(largest_skew, milliseconds(3));
  EXPECT_LT(largest_skew, std::chrono::microseconds(3509));
  EXPECT_EQ(camera->report().delivered, 144U);
  EXPECT_EQ(camera->report().refused, 0U);
  EXPECT_FALSE(camera->next(pair)) << "the end is final";
}

TEST_F(RealDrive, WhatIsPassedOverIsNotReadAndTheRestIsTheSame) {
  const auto all = drive->camera();
  StereoPair expected, pair;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(all->next(expected));
  const auto from_there = drive->camera(expected.available - Duration(1));
  for (std::uint64_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(from_there->next(pair));
    EXPECT_EQ(pair.sequence, i);
    EXPECT_TRUE(pair.left.empty()) << "read for nobody";
  }
  ASSERT_TRUE(from_there->next(pair));
  EXPECT_EQ(pair.stamp, expected.stamp);
  EXPECT_EQ(pair.left.pixels, expected.left.pixels);
  EXPECT_EQ(pair.right.pixels, expected.right.pixels);

  const auto scans = drive->velodyne(Time::max());
  LidarScan scan;
  ASSERT_TRUE(scans->next(scan));
  EXPECT_TRUE(scan.points.empty());
}

TEST_F(RealDrive, Velodyne) {
  auto velodyne = drive->velodyne();
  LidarScan scan;
  std::uint64_t count = 0;
  while (velodyne->next(scan)) {
    ASSERT_EQ(scan.sequence, count++);
    EXPECT_LT(scan.start, scan.stamp);
    EXPECT_LT(scan.stamp, scan.end);
    EXPECT_EQ(scan.available, scan.end);
    EXPECT_GT(scan.end - scan.start, milliseconds(99));
    EXPECT_LT(scan.end - scan.start, milliseconds(108));
    if (scan.sequence == 0) {
      EXPECT_EQ(scan.stamp, parse_time("2011-09-26 13:10:51.158069617"));
      EXPECT_EQ(scan.start, parse_time("2011-09-26 13:10:51.106324297"));
      EXPECT_EQ(scan.end, parse_time("2011-09-26 13:10:51.209814938"));
      ASSERT_EQ(scan.points.size(), 115267U);
      EXPECT_EQ(scan.points.front().x, 69.467F);
      EXPECT_EQ(scan.points.front().y, 10.819F);
      EXPECT_EQ(scan.points.back().z, -1.734F);
      EXPECT_EQ(scan.points.back().reflectance, 0.0F);
    } else if (scan.sequence == 143) {
      EXPECT_EQ(scan.points.size(), 112484U);
      EXPECT_EQ(scan.points.back().reflectance, 0.3F);
    }
  }
  EXPECT_EQ(count, 144U);
  EXPECT_EQ(velodyne->report().refused, 0U);
  EXPECT_EQ(velodyne->report().flawed, 0U);
}

TEST_F(RealDrive, ImuBelongsSixtyMillisecondsBeforeItsRow) {
  auto source = drive->imu();
  const auto imu = read_all(*source);
  ASSERT_EQ(imu.size(), 144U);
  expect_complete(source->report(), imu);
  const Time row = parse_time("2011-09-26 13:10:51.175862102");
  EXPECT_EQ(imu[0].available, row);
  EXPECT_EQ(imu[0].stamp, row - milliseconds(60));
  EXPECT_EQ(imu[0].specific_force_forward, -0.43999459306673);
  EXPECT_EQ(imu[0].specific_force_left, 0.088955239453583);
  EXPECT_EQ(imu[0].yaw_rate, 0.0062110895146255);
  EXPECT_TRUE(imu[0].six_axes);
  EXPECT_EQ(imu[143].available, parse_time("2011-09-26 13:11:05.986181190"));
}

TEST_F(RealDrive, ImuDelayIsAParameter) {
  KittiDriveParameters parameters;
  parameters.imu_delay = 0.0;
  ImuSample sample;
  ASSERT_TRUE(KittiDrive(maploop::testing::drive_0013(), parameters).imu()->next(sample));
  EXPECT_EQ(sample.stamp, sample.available);
}

TEST_F(RealDrive, Reference) {
  auto source = drive->reference();
  const auto reference = read_all(*source);
  ASSERT_EQ(reference.size(), 144U);
  expect_complete(source->report(), reference);
  const ReferencePose& first = reference[0];
  EXPECT_EQ(first.stamp, parse_time("2011-09-26 13:10:51.175862102"));
  EXPECT_EQ(first.velocity_stamp, first.stamp - milliseconds(60));
  EXPECT_EQ(first.available, first.stamp);
  EXPECT_DOUBLE_EQ(degrees(first.position.latitude), 49.013141872681);
  EXPECT_DOUBLE_EQ(degrees(first.position.longitude), 8.4378138518088);
  EXPECT_EQ(first.position.height, 114.06644439697);
  EXPECT_EQ(first.velocity_enu,
            Eigen::Vector3d(-3.290687456108, 11.375996992995, 0.040323535587709));
  EXPECT_EQ(first.attitude.pitch, -0.009947);
  EXPECT_EQ(first.attitude.roll, -0.000229);
  // A yaw of 105.75 degrees is a little west of north.
  EXPECT_NEAR(degrees(first.attitude.azimuth), 90.0 - 105.7505, 1e-3);
  EXPECT_EQ(first.position_accuracy, 0.14961617559609);
}

// The car drives in the direction of its attitude: its velocity is along its azimuth, and its path
// along its velocity.
TEST_F(RealDrive, ReferenceAttitudeVelocityAndPositionFitTogether) {
  const auto reference = read_all(*drive->reference());
  const LocalFrame frame(reference[0].position);
  double length = 0, from_velocity = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Eigen::Vector3d v_body =
        rotation_enu_body(reference[i].attitude).transpose() * reference[i].velocity_enu;
    EXPECT_GT(v_body.x(), 5.0);
    EXPECT_LT(std::fabs(v_body.y() / v_body.x()), 0.05);
    EXPECT_LT(std::fabs(v_body.z() / v_body.x()), 0.05);
    if (i == 0) continue;
    length +=
        (frame.to_enu(reference[i].position) - frame.to_enu(reference[i - 1].position)).norm();
    from_velocity += 0.5 * (reference[i].velocity_enu + reference[i - 1].velocity_enu).norm() *
                     to_seconds(reference[i].stamp - reference[i - 1].stamp);
  }
  EXPECT_NEAR(length, 173.0, 1.0);
  EXPECT_NEAR(length / from_velocity, 1.0, 0.005);
}

TEST_F(RealDrive, GnssAidOncePerSecondAndNeverTheRow) {
  auto source = drive->gnss();
  const auto fixes = read_all(*source);
  const auto reference = read_all(*drive->reference());
  expect_complete(source->report(), fixes);
  const std::vector<std::size_t> rows{0,  10, 20, 29,  39,  49,  58, 68,
                                      78, 87, 97, 107, 116, 126, 136};
  ASSERT_EQ(fixes.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const ReferencePose& row = reference[rows[k]];
    EXPECT_EQ(fixes[k].sequence, k);
    EXPECT_EQ(fixes[k].stamp, row.stamp);
    EXPECT_EQ(fixes[k].available, row.stamp);
    EXPECT_EQ(fixes[k].velocity_stamp, row.stamp - milliseconds(60));
    const Eigen::Vector3d error = LocalFrame(row.position).to_enu(fixes[k].position);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NE(error(axis), 0.0);
    EXPECT_GT(error.norm(), 0.05);
    EXPECT_LT(error.norm(), 5.0 * std::sqrt(3 * 3.25));
    EXPECT_LT((fixes[k].velocity_enu - row.velocity_enu).norm(), 0.6);
    EXPECT_NE(fixes[k].velocity_enu, row.velocity_enu);
  }
}

TEST_F(RealDrive, GnssSeedDecidesTheBits) {
  GnssAidParameters other;
  other.seed = 7;
  const auto a = read_all(*drive->gnss());
  const auto b = read_all(*KittiDrive(maploop::testing::drive_0013()).gnss());
  const auto c = read_all(*drive->gnss(other));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].position.latitude, b[k].position.latitude);
    EXPECT_EQ(a[k].velocity_enu, b[k].velocity_enu);
    EXPECT_NE(a[k].position.latitude, c[k].position.latitude);
  }
}

TEST_F(RealDrive, OpensWithOrWithoutTrailingSlash) {
  const std::string path = maploop::testing::drive_0013().string();
  for (const std::string& form : {path + "/", path + "//", path + "/.", path + "/oxts/.."}) {
    EXPECT_EQ(KittiDrive(form).frame_count(), 144U) << form;
  }
}

TEST_F(RealDrive, SourcesOutliveTheDrive) {
  auto imu = drive->imu();
  auto camera = drive->camera();
  drive.reset();
  ImuSample sample;
  StereoPair pair;
  EXPECT_TRUE(imu->next(sample));
  EXPECT_TRUE(camera->next(pair));
}

}  // namespace
}  // namespace maploop::sensors
