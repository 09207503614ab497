// A whole drive: the same bytes again, and readable as KITTI's are.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include "sensors/replay/kitti_drive.h"
#include "tests/support/real_data.h"
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
    return {1.0, 7, ImuGrade::tactical, threads};
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
    // Neither dark nor washed out.
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

TEST_F(SimulatedDrive, BrokenOffNothingIsLeft) {
  EXPECT_FALSE(simulate_drive(folder("half"), a_second(2),
                              [](std::size_t done, std::size_t) { return done < 2; }));
  EXPECT_TRUE(fs::is_empty(temporary_.path()));
}

TEST_F(SimulatedDrive, WhatCannotBeIsRefused) {
  EXPECT_THROW(simulate_drive(folder("short"), {0.5, 1, ImuGrade::tactical, 1}),
               std::invalid_argument);
  EXPECT_THROW(simulate_drive("/proc/nowhere/town", a_second(1)), std::exception);
}

}  // namespace
}  // namespace maploop::simulate
