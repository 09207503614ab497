// Tests a whole drive: the bytes are reproducible, and it is readable like KITTI's drives.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/velodyne_source.h"
#include "tests/support/real_data.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/simulation.h"

namespace maploop::simulate {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    files[fs::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return files;
}

template <class T>
std::size_t delivered(sensors::Source<T>& source) {
  T sample;
  while (source.next(sample)) {
  }
  EXPECT_EQ(source.report().refused, 0U);
  return source.report().delivered;
}

class SimulatedDrive : public ::testing::Test {
 protected:
  fs::path folder(const char* name) const { return temporary_.path() / name; }
  static SimulationOptions a_second(unsigned threads) {
    SimulationOptions options;
    options.seconds = 1.0;
    options.seed = 7;
    options.threads = threads;
    return options;
  }

  maploop::testing::TemporaryFolder temporary_;
};

TEST_F(SimulatedDrive, SameSeedSameBytesWhateverTheThreads) {
  ASSERT_TRUE(simulate_drive(folder("one"), a_second(1)));
  ASSERT_TRUE(simulate_drive(folder("two"), a_second(2)));
  const auto one = contents(folder("one")), two = contents(folder("two"));
  ASSERT_EQ(one.size(), two.size());
  for (const auto& [name, bytes] : one) {
    ASSERT_TRUE(two.contains(name)) << name;
    EXPECT_TRUE(bytes == two.at(name)) << name;
  }

  const sensors::KittiDrive drive(folder("one") / "town_extract");
  EXPECT_EQ(drive.frame_count(), 9U);
  EXPECT_EQ(delivered(*drive.camera()), 9U);
  EXPECT_EQ(delivered(*drive.velodyne()), 9U);
  EXPECT_EQ(delivered(*drive.imu()), 100U);
  const sensors::KittiDrive synced(folder("one") / "town_sync");
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

  EXPECT_THROW(simulate_drive(folder("one"), a_second(1)), std::runtime_error);
}

TEST_F(SimulatedDrive, PackedScansHoldTheSamePointsInATenthOfTheBytes) {
  SimulationOptions options = a_second(1);
  options.sensors = {false, true, false, false};
  ASSERT_TRUE(simulate_drive(folder("plain"), options));
  options.compact = true;
  ASSERT_TRUE(simulate_drive(folder("compact"), options));
  const auto scans = [&](const char* name) {
    const fs::path velodyne = folder(name) / "town_sync/velodyne_points";
    const auto stamps = [&](const char* file) { return sensors::read_timestamps(velodyne / file); };
    return sensors::make_velodyne_source({velodyne / "data", stamps("timestamps_start.txt"),
                                          stamps("timestamps.txt"), stamps("timestamps_end.txt")},
                                         std::chrono::milliseconds(250));
  };
  const auto plain = scans("plain"), compact = scans("compact");
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
  const auto size = [&](const char* name) {
    std::uintmax_t sum = 0;
    for (const auto& e : fs::recursive_directory_iterator(folder(name) / "town_sync"))
      if (e.is_regular_file()) sum += e.file_size();
    return sum;
  };
  EXPECT_LT(10 * size("compact"), size("plain"));
}

TEST_F(SimulatedDrive, AFreeScannerTurnsBesideTheCameras) {
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

TEST_F(SimulatedDrive, BrokenOffNothingIsLeft) {
  EXPECT_FALSE(simulate_drive(folder("half"), a_second(2),
                              [](std::size_t done, std::size_t) { return done < 2; }));
  EXPECT_TRUE(fs::is_empty(temporary_.path()));
}

TEST_F(SimulatedDrive, WhatCannotBeIsRefused) {
  SimulationOptions half = a_second(1);
  half.seconds = 0.5;
  EXPECT_THROW(simulate_drive(folder("short"), half), std::invalid_argument);
  EXPECT_THROW(simulate_drive("/proc/nowhere/town", a_second(1)), std::exception);
}

}  // namespace
}  // namespace maploop::simulate
