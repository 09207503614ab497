// What the watchdog says: of facts made up here, and of a running graph.
#include "runtime/vehicle/health/watchdog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/runtime/vehicle/memory_bus.h"

namespace maploop::vehicle {
namespace {

using testing::drive_start;
using Sentences = std::vector<std::string>;

constexpr StageSpec sensor{
    .name = "sensor", .runs = "", .released = "", .min_rate = 2.0, .max_rate = 20.0};
constexpr StageSpec worker{
    .name = "worker", .runs = "", .released = "", .min_rate = 2.0, .max_rate = 20.0};
constexpr StageSpec unwatched{.name = "idle", .runs = "", .released = ""};

class WatchdogTest : public ::testing::Test {
 protected:
  // One look, `ms` of data time and of the machine's clock after the start.
  Sentences look(int ms, std::uint64_t count, std::size_t waiting = 0,
                 const std::string& waits_for = "") {
    return watchdog_.look(drive_start + milliseconds(ms), wall_ + milliseconds(ms),
                          {count, waiting, waits_for});
  }
  void watch(const StageSpec& stage, Watchdog::Kind kind) {
    watchdog_ = Watchdog(stage, kind, drive_start, wall_);
  }

  MonotonicTime wall_ = runtime::monotonic_now();
  Watchdog watchdog_{sensor, Watchdog::Kind::driver, drive_start, wall_};
};

TEST_F(WatchdogTest, HasPatienceForThreePeriodsButNotLessThanItsOwn) {
  EXPECT_EQ(Watchdog::patience(sensor), milliseconds(1500));
  EXPECT_EQ(Watchdog::patience(stages::fusion), stages::health.period);
}

TEST_F(WatchdogTest, IsContentWithAStageInItsBounds) {
  for (int s = 1; s < 10; ++s) {
    EXPECT_EQ(look(1000 * s, static_cast<std::uint64_t>(10 * s)), Sentences{});
  }
}

TEST_F(WatchdogTest, NamesASensorSilentSinceTheStart) {
  EXPECT_EQ(look(1000, 0), Sentences{});
  const Sentences at_two_seconds = look(2000, 0);
  ASSERT_EQ(at_two_seconds.size(), 1U);
  EXPECT_EQ(at_two_seconds[0],
            "sensor: silent since the start, 2 s ago; is the sensor on, and connected?");
}

TEST_F(WatchdogTest, NamesAnInputThatBecameStaleUntilItIsBack) {
  EXPECT_EQ(look(1000, 10), Sentences{});
  EXPECT_EQ(look(2000, 20), Sentences{});
  EXPECT_EQ(look(3000, 20), Sentences{});
  EXPECT_EQ(look(4000, 20), Sentences{"sensor: stale, nothing new for 2 s"});
  EXPECT_EQ(look(5000, 20), Sentences{"sensor: stale, nothing new for 3 s"});
  look(6000, 30);
  look(7000, 40);
  EXPECT_EQ(look(8000, 50), Sentences{});
}

TEST_F(WatchdogTest, NamesARateBelowAndAboveItsBounds) {
  look(2000, 2);  // one sample at each end may belong to the next interval
  EXPECT_EQ(look(4000, 4), Sentences{"sensor: 1 Hz over 2 s, 2 to 20 Hz expected"});
  EXPECT_EQ(look(6000, 12), Sentences{});
  EXPECT_EQ(look(8000, 112), Sentences{"sensor: 50 Hz over 2 s, 2 to 20 Hz expected"});
  EXPECT_EQ(look(10000, 132), Sentences{});
}

TEST_F(WatchdogTest, AStageThatDoesNotMoveWithWorkBeforeItIsStuckEvenWhereDataTimeStandsStill) {
  watch(worker, Watchdog::Kind::fed);
  const auto at = [&](int wall_ms, std::size_t waiting, const std::string& waits_for) {
    return watchdog_.look(drive_start + milliseconds(100), wall_ + milliseconds(wall_ms),
                          {1, waiting, waits_for});
  };
  EXPECT_EQ(at(100, 0, "a -> worker"), Sentences{});
  EXPECT_EQ(at(1100, 4, ""), Sentences{});
  EXPECT_EQ(at(2100, 4, ""), Sentences{"worker: stuck for 2 s with 4 samples before it"});
  EXPECT_EQ(at(3100, 4, "b -> worker"),
            Sentences{"worker: stuck for 3 s with 4 samples before it, waiting for 'b -> worker'"});
}

TEST_F(WatchdogTest, AStageWithoutInputIsStaleAndNotStuck) {
  watch(worker, Watchdog::Kind::fed);
  look(1000, 10);
  EXPECT_EQ(look(4000, 10), Sentences{"worker: stale, nothing new for 3 s"});
}

TEST_F(WatchdogTest, AccusesNoSensorThatIsOnlyAhead) {
  const auto at = [&](int ms, std::uint64_t count, int newest_ms) {
    return watchdog_.look(drive_start + milliseconds(ms), wall_ + milliseconds(ms),
                          {count, 0, "", drive_start + milliseconds(newest_ms)});
  };
  EXPECT_EQ(at(1000, 100, 10'000), Sentences{});
  for (int ms = 2000; ms < 10'000; ms += 1000) EXPECT_EQ(at(ms, 100, 10'000), Sentences{}) << ms;
  EXPECT_EQ(at(10'500, 105, 10'500), Sentences{});
  EXPECT_EQ(at(13'000, 105, 10'500), Sentences{"sensor: stale, nothing new for 2.5 s"});
}

TEST_F(WatchdogTest, AFirstLookAtTheEndSeesASensorThatHasDied) {
  EXPECT_EQ(watchdog_.look(drive_start + milliseconds(45'000), wall_ + milliseconds(5000),
                           {300, 0, "", drive_start + milliseconds(15'000)}),
            Sentences{"sensor: stale, nothing new for 30 s"});
}

TEST_F(WatchdogTest, LeavesStagesWithoutRatesAlone) {
  watch(unwatched, Watchdog::Kind::driver);
  EXPECT_EQ(look(100000, 0), Sentences{});
}

// What each HEALTH message of a run found wanting.
std::vector<Sentences> degraded(const testing::MemoryBus& bus) {
  std::vector<Sentences> all;
  for (const auto& health : bus.decoded<maploop_lcm::health_t>(channels::health.name)) {
    all.push_back(health.degraded);
  }
  return all;
}

bool any_starts(const Sentences& sentences, const std::string& start) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.starts_with(start); });
}

// In how many messages a sentence starts so.
std::size_t count(const std::vector<Sentences>& messages, const std::string& start) {
  return static_cast<std::size_t>(
      std::count_if(messages.begin(), messages.end(),
                    [&](const Sentences& sentences) { return any_starts(sentences, start); }));
}

TEST(WatchdogInTheGraph, NamesSilentStaleAndMissingSensorsAndTheRestGoesOn) {
  Sensors sensors = testing::fake_sensors(9.0);
  sensors.velodyne = nullptr;
  testing::MemoryBus bus;
  testing::drive({.sensors = std::move(sensors),
                  .speed = 2.0,
                  .faults = {"lost@imu:2:5", "lost@gnss:0:20"},
                  .sinks = {&bus}});
  const std::vector<Sentences> messages = degraded(bus);
  ASSERT_GE(messages.size(), 9U);
  EXPECT_EQ(count(messages, "velodyne: there is none"), messages.size());
  EXPECT_GE(count(messages, "imu: stale, nothing new for"), 2U);
  EXPECT_GE(count(messages, "gnss: silent since the start"), 2U);
  // (It may also say that it got no real-time priority.)
  EXPECT_EQ(count(messages, "camera: stale") + count(messages, "camera: silent"), 0U);
  EXPECT_FALSE(any_starts(messages.back(), "imu: stale")) << "the sensor is back";
}

TEST(WatchdogInTheGraph, NamesAStuckStageAndWhoWaitsForIt) {
  std::atomic<std::uint64_t> struck = 0;
  StageDelays delays;
  delays["stereo"].add({drive_start + milliseconds(1000), drive_start + milliseconds(1100)},
                       milliseconds(3500), struck);
  testing::MemoryBus bus;
  Vehicle vehicle({}, testing::fake_calibration(), testing::fake_sensors(3.0),
                  runtime::DataClock::paced(1.0), {&bus}, {});
  vehicle.slow_down(delays);
  vehicle.start();
  vehicle.wait();
  EXPECT_EQ(struck, 1U);
  const std::vector<Sentences> messages = degraded(bus);
  EXPECT_GE(count(messages, "stereo: stuck for "), 1U);
  EXPECT_GE(count(messages, "fusion: stuck for "), 1U);
  EXPECT_FALSE(any_starts(messages.back(), "stereo: stuck")) << "it moves again";
}

}  // namespace
}  // namespace maploop::vehicle
