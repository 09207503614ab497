// After the first seconds of a real drive with images, scans, and the road map, no real-time
// thread allocates, but where OpenCV tracks features; nor does one of a drive with PPP.
#include <gtest/gtest.h>

#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::WatchedThread;

// Drives along a recording with a map that feeds back, and returns what the threads allocate
// between two moments.
std::vector<WatchedThread> allocated(const Recording& recording, const std::string& map_file,
                                     double speed, Duration from, Duration to) {
  testing::Drive d{.sensors = recording.sensors(Time::min()),
                   .speed = speed,
                   .calibration = recording.calibration};
  limit(d.sensors, recording.first_stamp + to + std::chrono::seconds(1));
  MapParameters map;
  map.file = (maploop::testing::real_data() / "maps" / map_file).string();
  d.map = load_road_map(map);
  d.config.map.mode = MapMode::tight;
  bool begun = false;
  d.look = [&](const NavState& state) {
    const Duration at = state.stamp - recording.first_stamp;
    if (!begun && at >= from) maploop::testing::watch_allocations();
    if (at >= to) maploop::testing::unwatch_allocations();
    begun = begun || at >= from;
  };
  const testing::Driven driven = testing::drive(std::move(d));
  maploop::testing::unwatch_allocations();
  EXPECT_TRUE(begun);
  EXPECT_GT(driven.matches.size(), 100U);
  EXPECT_GT(driven.feedbacks.size(), 20U);
  return maploop::testing::watched_allocations();
}

// Prints what was seen, and expects that no other thread has allocated.
void expect_only(const std::set<std::string>& may, const std::vector<WatchedThread>& threads) {
  for (const WatchedThread& thread : threads) {
    std::cout << thread.name << ": " << thread.allocations << '\n';
    for (const std::string& caller : thread.callers) std::cout << "  " << caller << '\n';
    EXPECT_TRUE(may.contains(thread.name)) << thread.name;
  }
}

TEST(DriveAllocation, OnlyOpenCvAllocatesAfterTheFirstSeconds) {
  MAPLOOP_REQUIRE_DRIVE();
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  // Not in real time: loaders read files, and health and publisher report, the latter to this test,
  // which keeps the messages. OpenCV's workers have the name of the thread that called it first.
  // On virtual time the stereo thread would be through before the fusion has come to the beginning.
  const std::vector<WatchedThread> threads = allocated(
      open_recording(maploop::testing::drive_0013(), VehicleConfig{}), "karlsruhe_2012-04.osm.pbf",
      2.0, std::chrono::seconds(6), std::chrono::seconds(14));
  expect_only({"camera loader", "velodyne loader", "health", "publisher", "stereo"}, threads);
  bool tracked = false;
  for (const WatchedThread& thread : threads) {
    if (thread.name != "stereo") continue;
    for (const std::string& caller : thread.callers) {
      const bool of_the_tracker = caller.find("stereo::track_points") != std::string::npos;
      EXPECT_TRUE(of_the_tracker || caller.ends_with(" by another library")) << caller;
      tracked = tracked || of_the_tracker;
    }
  }
  EXPECT_TRUE(tracked) << "the watch sees what allocates";
}

TEST(DriveAllocation, PrecisePointPositioningAllocatesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  // A recorded receiver's thread copies the epochs of its file; live ones have a test of their own.
  expect_only({"health", "publisher", "gnss"},
              allocated(open_recording(maploop::testing::real_data() /
                                           "gnss/riverside_drive/COM3_200712.obs.gz",
                                       VehicleConfig{}),
                        "riverside/riverside_from_2021_drives.osm.pbf", 60.0,
                        std::chrono::seconds(60), std::chrono::seconds(240)));
}

}  // namespace
}  // namespace maploop::vehicle
