// After the first seconds of a real drive with images, scans, and the road map, no real-time
// thread allocates, but where OpenCV tracks features.
#include <gtest/gtest.h>

#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/counted_allocations.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::WatchedThread;

// Returns what the threads allocate between two moments of the recorded drive.
std::vector<WatchedThread> allocated(Duration from, Duration to) {
  const Recording recording = open_recording(maploop::testing::drive_0013(), VehicleConfig{});
  // On virtual time the stereo thread would be through before the fusion has come to `from`.
  testing::Drive d{.sensors = recording.sensors(Time::min()),
                   .speed = 2.0,
                   .calibration = recording.calibration};
  MapParameters map;
  map.file = (maploop::testing::real_data() / "maps/karlsruhe_2012-04.osm.pbf").string();
  d.map = load_road_map(map);
  d.config.map.mode = MapMode::tight;
  bool begun = false;
  d.look = [&](const NavState& state) {
    const Duration at = state.stamp - recording.first_stamp;
    if (!begun && at >= from) maploop::testing::watch_allocations();
    if (at >= to) maploop::testing::unwatch_allocations();
    begun = at >= from;
  };
  const testing::Driven driven = testing::drive(std::move(d));
  EXPECT_GT(driven.matches.size(), 100U);
  EXPECT_GT(driven.feedbacks.size(), 100U);
  return maploop::testing::watched_allocations();
}

TEST(DriveAllocation, OnlyOpenCvAllocatesAfterTheFirstSeconds) {
  MAPLOOP_REQUIRE_DRIVE();
  if (!maploop::testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  // Not in real time: loaders read files, and health and publisher report, the latter to this test,
  // which keeps the messages. OpenCV's workers have the name of the thread that called it first.
  const std::set<std::string> may{"camera loader", "velodyne loader", "health", "publisher",
                                  "stereo"};
  bool tracked = false;
  for (const WatchedThread& thread : allocated(std::chrono::seconds(6), std::chrono::seconds(14))) {
    std::cout << thread.name << ": " << thread.allocations << '\n';
    for (const std::string& caller : thread.callers) std::cout << "  " << caller << '\n';
    EXPECT_TRUE(may.contains(thread.name)) << thread.name;
    if (thread.name != "stereo") continue;
    for (const std::string& caller : thread.callers) {
      const bool of_the_tracker = caller.find("stereo::track_points") != std::string::npos;
      EXPECT_TRUE(of_the_tracker || caller.ends_with(" by another library")) << caller;
      tracked = tracked || of_the_tracker;
    }
  }
  EXPECT_TRUE(tracked) << "the watch sees what allocates";
}

}  // namespace
}  // namespace maploop::vehicle
