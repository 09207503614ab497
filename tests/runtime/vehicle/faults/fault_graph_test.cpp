// Every fault through the whole graph, on made-up sensors: nothing crashes, hangs or is lost
// silently, and a fault of the samples is the same fault at every speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/vehicle/faults/fault_injection.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using runtime::DataClock;
using testing::drive_start;

struct Replayed {
  VehicleReport report;
  std::map<std::string, ChannelSummary> channels;
  std::vector<NavState> states;
  std::vector<FaultCount> faults;

  std::map<std::string, std::string> hashes() const {
    std::map<std::string, std::string> all;
    for (const auto& [name, channel] : channels) {
      if (!channel.hash.empty()) all[name] = channel.hash;
    }
    return all;
  }
  std::uint64_t refused(const std::string& stage, const std::string& reason) const {
    for (const RefusalCount& r : report.health.refusals) {
      if (r.stage == stage && r.reason == reason) return r.count;
    }
    return 0;
  }
  std::uint64_t misses(const std::string& thread) const {
    for (const LatencySummary& s : report.deadlines.threads) {
      if (s.name == thread) return s.misses;
    }
    return 0;
  }
};

// Whether it comes to its end by itself, within a bound that no machine needs.
bool ends(Vehicle& vehicle) {
  const MonotonicTime bound = runtime::monotonic_now() + std::chrono::minutes(2);
  while (vehicle.running() && runtime::monotonic_now() < bound) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const bool ended = !vehicle.running();
  vehicle.stop();
  vehicle.wait();
  return ended;
}

Replayed replay(
    const std::vector<std::string>& texts, const DataClock& clock, double seconds,
    const std::function<void(const NavState&)>& look = [](const NavState&) {}) {
  std::vector<Fault> faults;
  for (const std::string& text : texts) faults.push_back(parse_fault(text));
  FaultInjection injection(std::move(faults), drive_start);
  ChannelHashes hashes;
  Replayed r;
  Observer observer;
  observer.nav_state = [&](const NavState& state) {
    r.states.push_back(state);
    look(state);
  };
  Vehicle vehicle({}, testing::fake_calibration(), injection.inject(testing::fake_sensors(seconds)),
                  clock, {&hashes}, observer);
  vehicle.slow_down(injection.delays());
  const auto hogs = injection.hogs([&] { return vehicle.position(); });
  vehicle.start();
  EXPECT_TRUE(ends(vehicle));
  r.report = vehicle.report();
  r.channels = hashes.summary();
  r.faults = injection.counts();
  return r;
}

Replayed lockstep(const std::vector<std::string>& texts, double seconds = 4.0) {
  return replay(texts, DataClock::virtual_time(), seconds);
}

void expect_healthy(const Replayed& r) {
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_EQ(thread.failure, "") << thread.name;
  }
  for (const RingHealth& ring : r.report.health.rings) {
    EXPECT_EQ(ring.pushed, ring.popped) << ring.name;
    EXPECT_EQ(ring.lost + ring.held, 0u) << ring.name;
  }
  for (const NavState& state : r.states) {
    ASSERT_TRUE(state.position_enu.allFinite() && state.covariance.allFinite());
  }
  for (const FaultCount& fault : r.faults) EXPECT_GT(fault.struck, 0u) << fault.fault;
}

class FaultOfSamples : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultOfSamples, HasTheSameBitsAtEverySpeed) {
  const Replayed first = lockstep({GetParam()});
  expect_healthy(first);
  const Replayed paced = replay({GetParam()}, DataClock::paced(20.0), 4.0);
  expect_healthy(paced);
  EXPECT_EQ(first.hashes(), paced.hashes());
  const bool no_scans = std::string_view(GetParam()) == "lost@velodyne";  // no LIDAR_ODOMETRY
  EXPECT_EQ(first.hashes().size(), no_scans ? 6u : 7u);
}

INSTANTIATE_TEST_SUITE_P(
    Each, FaultOfSamples,
    ::testing::Values("late@camera:1:1,by=0.5", "late@imu:1:1,by=3", "late@gnss",
                      "late@velodyne:1:1", "lost@camera:1:2", "lost@imu:1:2",
                      "lost@imu,share=0.5,seed=3", "lost@gnss:0:2", "lost@velodyne",
                      "duplicated@camera:1:1", "duplicated@imu", "duplicated@gnss",
                      "duplicated@velodyne", "reordered@camera:1:1", "reordered@imu",
                      "reordered@gnss", "reordered@velodyne", "jump@camera:1:1,by=3",
                      "jump@camera:1:end,by=-5", "jump@imu:1:1,by=3", "jump@imu:1,by=-3600",
                      "jump@gnss:0:2,by=20", "jump@velodyne:1", "nan@imu:1:1", "nan@gnss:0:2",
                      "frozen@imu:1:1", "frozen@gnss:1", "nan@velodyne", "black@camera:1:1",
                      "garbage@camera:1:1"));

TEST(FaultBurst, OfMoreThanARingHoldsGoesThroughWithTheSameBits) {
  const std::vector<std::string> burst{"late@imu:0.5:0.5,by=5"};
  const Replayed first = lockstep(burst, 7.0);  // 500 samples within one nanosecond each
  expect_healthy(first);
  EXPECT_EQ(first.channels.at("IMU").count, 700u);
  const Replayed paced = replay(burst, DataClock::paced(20.0), 7.0);
  expect_healthy(paced);
  EXPECT_EQ(first.hashes(), paced.hashes());
}

class BrokenStage : public ::testing::TestWithParam<const char*> {};

TEST_P(BrokenStage, IsNamedAndTheRestGoesOn) {
  const std::string stage = GetParam();
  const Replayed clean = lockstep({}, 6.0);
  const Replayed r = lockstep({"broken@" + stage + ":1"}, 6.0);
  EXPECT_EQ(r.faults.at(0).struck, 1u);
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_EQ(thread.failure, thread.name == stage ? "ended by an injected fault" : "");
  }
  for (const char* channel : {"IMU", "GNSS_FIX", "TRUTH"}) {
    EXPECT_EQ(r.hashes().at(channel), clean.hashes().at(channel)) << channel;
  }
  if (stage != "fusion") {
    EXPECT_GE(r.states.size(), 600u) << "as long as there are inertial samples";
  }
  if (stage != "stereo") {
    EXPECT_EQ(r.hashes().at("VO"), clean.hashes().at("VO"));
  }
  for (const RingHealth& ring : r.report.health.rings) {
    EXPECT_EQ(ring.pushed, ring.popped + ring.lost + ring.held) << ring.name;
    if (!ring.name.ends_with(" -> " + stage)) {
      EXPECT_EQ(ring.lost + ring.held, 0u) << ring.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, BrokenStage, ::testing::Values("stereo", "lidar", "fusion"));

TEST(BrokenPublisher, IsNamedAndTheRestGoesOn) {
  const auto look = [states = 0](const NavState&) mutable {
    if (++states == 100) throw std::runtime_error("nobody to tell");
  };
  const Replayed r = replay({}, DataClock::virtual_time(), 6.0, look);
  EXPECT_EQ(r.states.size(), 100u);
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_EQ(thread.failure, thread.name == "publisher" ? "nobody to tell" : "");
    if (thread.name == "imu") {
      EXPECT_EQ(thread.count, 600u);
    }
  }
}

TEST(FaultOfTiming, NeverChangesABit) {
  const auto clean = lockstep({}).hashes();
  for (const char* fault :
       {"slow@stereo,by=0.01", "slow@lidar,by=0.01", "slow@fusion,by=0.002", "hog@cpu:1:2"}) {
    const Replayed slow = lockstep({fault});
    expect_healthy(slow);
    EXPECT_EQ(slow.hashes(), clean) << fault;
    const Replayed paced = replay({fault}, DataClock::paced(4.0), 4.0);
    expect_healthy(paced);
    EXPECT_EQ(paced.hashes(), clean) << fault;
  }
}

TEST(FaultOfTiming, ASlowStereoStageMissesItsDeadlinesAndHoldsTheDataClockUp) {
  const Replayed r = replay({"slow@stereo:1:1,by=0.2"}, DataClock::paced(1.0), 3.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 10u);
  EXPECT_GE(r.misses("stereo"), 10u);
  EXPECT_GT(r.report.stalls, 0u);
  // Ten images take 2 s instead of one.
  EXPECT_GT(r.report.stalled, std::chrono::milliseconds(800));
}

TEST(FaultOfTiming, ASlowFusionStageMissesItsDeadlines) {
  const Replayed r = replay({"slow@fusion:1:0.5,by=0.02"}, DataClock::paced(1.0), 3.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 50u);
  EXPECT_GE(r.misses("fusion"), 50u);
}

TEST(FaultOfTiming, AFusionStageTooSlowForTheDataHoldsTheDataClockUp) {
  // 200 ticks take 4 s instead of two.
  const Replayed r = replay({"slow@fusion,by=0.02"}, DataClock::paced(1.0), 2.0);
  expect_healthy(r);
  EXPECT_GT(r.report.stalls, 0u);
  EXPECT_GT(r.report.stalled, std::chrono::milliseconds(1500));
}

TEST(FaultOfTiming, AHogEndsWithTheReplay) {
  const Replayed r = replay({"hog@cpu:0.2:60,threads=3"}, DataClock::paced(4.0), 1.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 3u);
}

bool says(const Replayed& r, const std::string& text) {
  const auto& all = r.report.health.degraded;
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& s) { return s.find(text) != std::string::npos; });
}

TEST(FaultWords, AnOutageThatHasEndedIsSaidAlsoOnVirtualTime) {
  const Replayed r = lockstep({"lost@imu:2:3"}, 8.0);
  EXPECT_TRUE(says(r, "imu: silent for 3.0")) << "from 2 s on";
  EXPECT_TRUE(says(lockstep({"lost@imu:2:end"}, 8.0), "imu: stale, nothing new for 6"));
  EXPECT_TRUE(says(lockstep({"lost@camera:2:3"}, 8.0), "camera: silent for 3"));
}

TEST(FaultWords, WhatAnEstimatorRefusesIsSaidWithItsReason) {
  EXPECT_TRUE(says(lockstep({"nan@imu:2:3"}, 8.0), " inertial samples from 2"));
  EXPECT_TRUE(says(lockstep({"nan@imu:2:3"}, 8.0), ": a value is not finite"));
  EXPECT_TRUE(says(lockstep({"jump@imu:2:3,by=3"}, 8.0), ": stamped later than delivered"));
  EXPECT_TRUE(says(lockstep({"jump@imu:2:end,by=-1"}, 8.0), " inertial samples since 2"))
      << "and it goes on";
  EXPECT_TRUE(says(lockstep({}, 8.0), "stereo refuses ")) << "there is nothing to see";
  EXPECT_FALSE(says(lockstep({"duplicated@imu"}, 8.0), " inertial samples "));
}

TEST(FaultRefusals, AnInertialClockThatIsRightAgainIsBelievedAgain) {
  for (const char* fault : {"jump@imu:1:2,by=0.05", "jump@imu:1:2,by=-0.05"}) {
    const Replayed r = lockstep({fault}, 8.0);
    EXPECT_LE(r.refused("fusion", "the sensor's clock has fallen back"), 200u) << fault;
    EXPECT_EQ(r.states.back().imu_stamp, lockstep({}, 8.0).states.back().imu_stamp) << fault;
  }
}

TEST(FaultRefusals, NanIsCountedSampleBySample) {
  const Replayed r = lockstep({"nan@imu:1:1", "nan@gnss:0:1.5"});
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 100u);
  EXPECT_EQ(r.faults.at(1).struck, 2u);
  EXPECT_EQ(r.refused("fusion", "a value is not finite"), 102u);
  EXPECT_EQ(r.states.front().status, NavStatus::uninitialized);
  EXPECT_NE(r.states.back().status, NavStatus::uninitialized) << "the third fix starts it";
}

TEST(FaultRefusals, DuplicatesAreCountedAndChangeNoState) {
  const Replayed clean = lockstep({});
  const Replayed r = lockstep({"duplicated@imu"});
  EXPECT_EQ(r.faults.at(0).struck, 400u);
  EXPECT_EQ(r.refused("fusion", "duplicate"), 400u);
  EXPECT_EQ(r.channels.at("NAV_STATE").hash, clean.channels.at("NAV_STATE").hash);
  EXPECT_EQ(r.channels.at("IMU").count, 800u);
}

TEST(FaultRefusals, ReorderedInertialSamplesAreNotLost) {
  const Replayed clean = lockstep({});
  const Replayed r = lockstep({"reordered@imu"});
  EXPECT_EQ(r.states.back().imu_stamp, clean.states.back().imu_stamp);
  EXPECT_EQ(r.states.back().position_enu, clean.states.back().position_enu)
      << "in the order of stamps they are the same";
}

TEST(FaultRefusals, OneSensorsClockDoesNotTakeTheStateDown) {
  for (const char* fault : {"jump@imu:1,by=1.5", "jump@imu:1,by=3", "jump@imu:1,by=100",
                            "jump@camera:1,by=3", "jump@imu:1,by=-3600"}) {
    const Replayed r = lockstep({fault});
    expect_healthy(r);
    EXPECT_NE(r.states.back().status, NavStatus::uninitialized) << fault;
    EXPECT_EQ(r.refused("fusion", "restart: the clock jumped"), 0u) << fault;
  }
}

TEST(FaultRefusals, AnAheadClockIsRefusedSampleBySample) {
  const Replayed r = lockstep({"jump@imu:1:1,by=3"});
  EXPECT_EQ(r.faults.at(0).struck, 100u);
  EXPECT_EQ(r.refused("fusion", "stamped later than delivered"), 100u);
}

}  // namespace
}  // namespace maploop::vehicle
