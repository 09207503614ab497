// Tests a whole drive: the bytes are reproducible, and it is readable like KITTI's drives.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/velodyne_source.h"
#include "tests/tools/simulate/made_drive.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/simulation.h"

namespace maploop::simulate {
namespace {

namespace fs = std::filesystem;

template <class T>
std::size_t delivered(sensors::Source<T>& source) {
  T sample;
  while (source.next(sample)) {
  }
  EXPECT_EQ(source.report().refused, 0U);
  return source.report().delivered;
}

SimulationOptions a_second(unsigned threads) {
  SimulationOptions options;
  options.seconds = 1.0;
  options.seed = 7;
  options.threads = threads;
  return options;
}

TEST(SimulatedDrive, SameSeedSameBytesWhateverTheThreads) {
  const fs::path one = made("one", a_second(1));
  expect_same_files(one, made("two", a_second(2)));
  EXPECT_THROW(simulate_drive(one, a_second(1)), std::runtime_error) << "it exists";
}

TEST(SimulatedDrive, ReadsLikeADriveOfKitti) {
  const fs::path made_drive = made("one", a_second(1));
  const sensors::KittiDrive drive(made_drive / "town_extract");
  EXPECT_EQ(drive.frame_count(), 9U);
  EXPECT_EQ(delivered(*drive.camera()), 9U);
  EXPECT_EQ(delivered(*drive.velodyne()), 9U);
  EXPECT_EQ(delivered(*drive.imu()), 100U);
  const sensors::KittiDrive synced(made_drive / "town_sync");
  EXPECT_EQ(delivered(*synced.imu()), 10U);
  const auto camera = drive.camera();
  for (StereoPair pair; camera->next(pair);) {
    // The image is neither dark nor overexposed.
    const auto& pixels = pair.left.pixels;
    const double bright = static_cast<double>(
        std::count_if(pixels.begin(), pixels.end(), [](auto p) { return p > 250; }));
    const double dark = static_cast<double>(
        std::count_if(pixels.begin(), pixels.end(), [](auto p) { return p < 5; }));
    EXPECT_LT(bright / static_cast<double>(pixels.size()), 0.2);
    EXPECT_LT(dark / static_cast<double>(pixels.size()), 0.1);
  }
  const auto velodyne = drive.velodyne();
  for (LidarScan scan; velodyne->next(scan);) EXPECT_GT(scan.points.size(), 60'000U);
}

TEST(SimulatedDrive, PackedScansHoldTheSamePointsInATenthOfTheBytes) {
  SimulationOptions options = a_second(1);
  const fs::path plain_drive = made("one", options);
  options.sensors = {false, true, false, false};
  options.compact = true;
  const fs::path compact_drive = made("compact", options);
  const auto scans = [](const fs::path& drive) {
    const fs::path velodyne = drive / "town_sync/velodyne_points";
    const auto stamps = [&](const char* file) { return sensors::read_timestamps(velodyne / file); };
    return sensors::make_velodyne_source({velodyne / "data", stamps("timestamps_start.txt"),
                                          stamps("timestamps.txt"), stamps("timestamps_end.txt")},
                                         std::chrono::milliseconds(250));
  };
  const auto plain = scans(plain_drive), compact = scans(compact_drive);
  std::size_t count = 0;
  for (LidarScan a, b; plain->next(a) && compact->next(b); ++count) {
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      ASSERT_EQ(a.points[i].x, b.points[i].x);
      ASSERT_EQ(a.points[i].z, b.points[i].z);
      ASSERT_EQ(a.points[i].reflectance, b.points[i].reflectance);
    }
  }
  EXPECT_EQ(count, 9U);
  const auto size = [](const fs::path& drive) {
    std::uintmax_t sum = 0;
    for (const auto& e : fs::directory_iterator(drive / "town_sync/velodyne_points/data"))
      sum += e.file_size();
    return sum;
  };
  EXPECT_LT(10 * size(compact_drive), size(plain_drive));
}

TEST(SimulatedDrive, AFreeScannerTurnsBesideTheCameras) {
  SimulationOptions options = a_second(1);
  const Drive free(options);
  options.free_scanner = false;
  const Drive triggered(options);
  const CalibrationErrors errors = calibration_errors(options.seed);
  ASSERT_EQ(free.turns.size(), free.times.size());
  EXPECT_NEAR(free.turns.front(), free.times.front() - 0.1 + errors.scanner_phase, 1e-9);
  EXPECT_NEAR(free.turn_time, 0.1 * (1.0 + errors.scanner_drift), 1e-9);
  for (std::size_t i = 1; i < free.turns.size(); ++i)
    EXPECT_NEAR(free.turns[i] - free.turns[i - 1], free.turn_time, 1e-9);
  for (std::size_t i = 0; i < triggered.turns.size(); ++i)
    EXPECT_NEAR(triggered.turns[i], triggered.times[i] - 0.05, 1e-9);
}

TEST(SimulatedDrive, ADrawnCarIsDescribedExactlyAndRoughly) {
  SimulationOptions options = a_second(1);
  options.car = CarKind::drawn;
  const Drive drive(options);
  const SimulatedCar& car = drive.car;
  const VehicleDescription exact = description_of(car), rough = rough_description(car, 7);
  // The rear axle moves along the car, not along the unit's own axes.
  const VehicleState state = drive.motion.state(0.5);
  const Eigen::Vector3d axle = car.T_car_body.inverse().translation();
  const Eigen::Vector3d velocity =
      state.T_enu_body.linear().transpose() * state.velocity_enu + state.rate_body.cross(axle);
  const Eigen::Vector3d travel = car.T_car_body.linear().row(0).transpose();
  EXPECT_LT(velocity.normalized().cross(travel).norm(), 0.02) << "springs and bumps";
  EXPECT_NEAR(exact.car.climb_offset, std::asin(travel.z()), 1e-12);
  EXPECT_LE(std::abs(exact.car.climb_offset), radians(1.01));
  EXPECT_GT(exact.car.rear_axle_distance, 0.0);
  EXPECT_LE(exact.car.rear_axle_distance, 2.0);
  EXPECT_EQ(exact.imu.time.delay, car.imu_delay);
  const auto apart = [](const SensorPosition& a, const SensorPosition& b) {
    return std::hypot(a.forward - b.forward, a.left - b.left);
  };
  EXPECT_NEAR(apart(exact.antenna.position, rough.antenna.position), 0.5, 1e-9);
  EXPECT_NEAR(apart(exact.camera.position, rough.camera.position), 0.5, 0.1);
  EXPECT_NEAR(std::abs(exact.camera.rotation.yaw - rough.camera.rotation.yaw), 1.0, 0.1);
  EXPECT_EQ(rough.car.rear_axle_distance, 0.0) << "its owner does not know it";
  EXPECT_EQ(rough.imu.time.delay, 0.0);
}

TEST(SimulatedDrive, TheCalibrationOfADrawnCarIsReadAsItIs) {
  SimulationOptions options = a_second(2);
  options.car = CarKind::drawn;
  options.sensors = {true, false, true, false};
  const fs::path made_drive = made("drawn", options);
  const sensors::KittiDrive drive(made_drive / "town_extract");
  const SimulatedCar car = simulated_car(CarKind::drawn, options.seed);
  EXPECT_TRUE(
      drive.calibration().stereo.T_body_cam.isApprox(calibration_of(car).stereo.T_body_cam, 1e-12));
  EXPECT_TRUE(fs::exists(made_drive / "vehicle_rough.toml"));
  const auto camera = drive.camera();
  StereoPair pair;
  ASSERT_TRUE(camera->next(pair));
  EXPECT_NEAR(to_seconds(pair.stamp - Drive(options).start), 0.1 + car.camera_delay, 1e-8);
}

TEST(SimulatedDrive, BrokenOffNothingIsLeft) {
  const maploop::testing::TemporaryFolder folder;
  EXPECT_FALSE(simulate_drive(folder.path() / "half", a_second(2),
                              [](std::size_t done, std::size_t) { return done < 2; }));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SimulatedDrive, WhatCannotBeIsRefused) {
  SimulationOptions half = a_second(1);
  half.seconds = 0.5;
  EXPECT_THROW(simulate_drive("short", half), std::invalid_argument);
  EXPECT_THROW(simulate_drive("/proc/nowhere/town", a_second(1)), std::exception);
}

}  // namespace
}  // namespace maploop::simulate
