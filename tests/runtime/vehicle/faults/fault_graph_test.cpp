// Every fault through the whole graph, on made-up sensors: nothing crashes, hangs or is lost
// silently, and a fault of the samples is the same fault at every speed.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/runtime/vehicle/driven.h"

namespace maploop::vehicle {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using testing::drive;
using testing::Driven;
using testing::fake_sensors;
using ::testing::HasSubstr;
using ::testing::Not;

Driven with_faults(const std::vector<std::string>& faults, double seconds = 4.0,
                   double speed = 0.0) {
  return drive({.sensors = fake_sensors(seconds), .speed = speed, .faults = faults});
}

std::uint64_t misses(const Driven& run, const std::string& thread) {
  for (const LatencySummary& s : run.report.deadlines.threads) {
    if (s.name == thread) return s.misses;
  }
  return 0;
}

void expect_healthy(const Driven& run) {
  for (const ThreadHealth& thread : run.report.health.threads) {
    EXPECT_EQ(thread.failure, "") << thread.name;
  }
  testing::expect_rings_balance(run.report, true);
  for (const NavState& state : run.states) {
    ASSERT_TRUE(state.position_enu.allFinite() && state.covariance.allFinite());
  }
  for (const FaultCount& fault : run.faults) EXPECT_GT(fault.struck, 0u) << fault.fault;
}

TEST(FaultOfSamples, HasTheSameBitsAtEverySpeed) {
  for (const std::string fault : {"late@camera:1:1,by=0.5",
                                  "late@imu:1:1,by=3",
                                  "late@gnss",
                                  "late@velodyne:1:1",
                                  "lost@camera:1:2",
                                  "lost@imu:1:2",
                                  "lost@imu,share=0.5,seed=3",
                                  "lost@gnss:0:2",
                                  "lost@velodyne",
                                  "duplicated@camera:1:1",
                                  "duplicated@imu",
                                  "duplicated@gnss",
                                  "duplicated@velodyne",
                                  "reordered@camera:1:1",
                                  "reordered@imu",
                                  "reordered@gnss",
                                  "reordered@velodyne",
                                  "jump@camera:1:1,by=3",
                                  "jump@camera:1:end,by=-5",
                                  "jump@imu:1:1,by=3",
                                  "jump@imu:1,by=-3600",
                                  "jump@gnss:0:2,by=20",
                                  "jump@velodyne:1",
                                  "nan@imu:1:1",
                                  "nan@gnss:0:2",
                                  "frozen@imu:1:1",
                                  "frozen@gnss:1",
                                  "nan@velodyne",
                                  "black@camera:1:1",
                                  "garbage@camera:1:1",
                                  "bias@gyro:1",
                                  "noise@accelerometer:1",
                                  "spoofed@gnss:1",
                                  "bumped@camera:1",
                                  "skewed@imu:1",
                                  "rain@velodyne:1"}) {
    SCOPED_TRACE(fault);
    const Driven first = with_faults({fault});
    expect_healthy(first);
    const Driven paced = with_faults({fault}, 4.0, 50.0);
    expect_healthy(paced);
    EXPECT_EQ(first.hashes(), paced.hashes());
    EXPECT_EQ(first.hashes().size(), fault == "lost@velodyne" ? 9u : 10u);  // no LIDAR_ODOMETRY
  }
}

TEST(FaultBurst, OfMoreThanARingHoldsGoesThroughWithTheSameBits) {
  const std::vector<std::string> burst{"late@imu:0.5:0.5,by=5"};
  const Driven first = with_faults(burst, 7.0);  // 500 samples within one nanosecond each
  expect_healthy(first);
  EXPECT_EQ(first.channels.at("IMU").count, 700u);
  const Driven paced = with_faults(burst, 7.0, 50.0);
  expect_healthy(paced);
  EXPECT_EQ(first.hashes(), paced.hashes());
}

TEST(BrokenStage, IsNamedAndTheRestGoesOn) {
  const Driven clean = with_faults({}, 6.0);
  for (const std::string stage : {"stereo", "lidar", "fusion"}) {
    SCOPED_TRACE(stage);
    const Driven r = with_faults({"broken@" + stage + ":1"}, 6.0);
    EXPECT_EQ(r.faults.at(0).struck, 1u);
    for (const ThreadHealth& thread : r.report.health.threads) {
      EXPECT_EQ(thread.failure, thread.name == stage ? "ended by an injected fault" : "");
    }
    for (const char* channel : {"IMU", "GNSS_FIX", "TRUTH", "VO"}) {
      if (channel == std::string("VO") && stage == "stereo") continue;
      EXPECT_EQ(r.hashes().at(channel), clean.hashes().at(channel)) << channel;
    }
    if (stage != "fusion") {
      EXPECT_GE(r.states.size(), 600u) << "as long as there are inertial samples";
    }
    testing::expect_rings_balance(r.report);
    for (const RingHealth& ring : r.report.health.rings) {
      if (ring.name.ends_with(" -> " + stage)) continue;
      EXPECT_EQ(ring.lost + ring.held, 0u) << ring.name;
    }
  }
}

TEST(BrokenPublisher, IsNamedAndTheRestGoesOn) {
  const auto look = [states = 0](const NavState&) mutable {
    if (++states == 100) throw std::runtime_error("nobody to tell");
  };
  const Driven r = drive({.sensors = fake_sensors(6.0), .look = look});
  EXPECT_EQ(r.states.size(), 100u);
  for (const ThreadHealth& thread : r.report.health.threads) {
    EXPECT_EQ(thread.failure, thread.name == "publisher" ? "nobody to tell" : "");
    if (thread.name == "imu") {
      EXPECT_EQ(thread.count, 600u);
    }
  }
}

TEST(FaultOfTiming, NeverChangesABit) {
  const auto clean = with_faults({}).hashes();
  for (const char* fault :
       {"slow@stereo,by=0.01", "slow@lidar,by=0.01", "slow@fusion,by=0.002", "hog@cpu:1:2"}) {
    const Driven slow = with_faults({fault});
    expect_healthy(slow);
    EXPECT_EQ(slow.hashes(), clean) << fault;
    const Driven paced = with_faults({fault}, 4.0, 8.0);
    expect_healthy(paced);
    EXPECT_EQ(paced.hashes(), clean) << fault;
  }
}

TEST(FaultOfTiming, ASlowStereoStageMissesItsDeadlinesAndHoldsTheDataClockUp) {
  const Driven r = with_faults({"slow@stereo:0.5:1,by=0.2"}, 1.6, 1.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 10u);
  EXPECT_GE(misses(r, "stereo"), 10u);
  EXPECT_GT(r.report.stalls, 0u);
  // Ten images take 2 s instead of one.
  EXPECT_GT(r.report.stalled, std::chrono::milliseconds(800));
}

TEST(FaultOfTiming, ASlowFusionStageMissesItsDeadlines) {
  const Driven r = with_faults({"slow@fusion:0.3:0.5,by=0.02"}, 1.0, 1.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 50u);
  EXPECT_GE(misses(r, "fusion"), 50u);
}

TEST(FaultOfTiming, AFusionStageTooSlowForTheDataHoldsTheDataClockUp) {
  // 100 ticks take 2 s instead of one.
  const Driven r = with_faults({"slow@fusion,by=0.02"}, 1.0, 1.0);
  expect_healthy(r);
  EXPECT_GT(r.report.stalls, 0u);
  EXPECT_GT(r.report.stalled, std::chrono::milliseconds(750));
}

TEST(FaultOfTiming, AHogEndsWithTheReplay) {
  const Driven r = with_faults({"hog@cpu:0.2:60,threads=3"}, 1.0, 4.0);
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 3u);
}

TEST(FaultWords, AnOutageThatHasEndedIsSaidAlsoOnVirtualTime) {
  const auto said = [](const char* fault) {
    return with_faults({fault}, 8.0).report.health.degraded;
  };
  EXPECT_THAT(said("lost@imu:2:3"), Contains(HasSubstr("imu: silent for 3.0"))) << "from 2 s on";
  EXPECT_THAT(said("lost@imu:2:end"), Contains(HasSubstr("imu: stale, nothing new for 6")));
  EXPECT_THAT(said("lost@camera:2:3"), Contains(HasSubstr("camera: silent for 3")));
}

TEST(FaultWords, WhatAnEstimatorRefusesIsSaidWithItsReason) {
  const auto said = [](const std::vector<std::string>& faults) {
    return with_faults(faults, 8.0).report.health.degraded;
  };
  EXPECT_THAT(said({"nan@imu:2:3"}), Contains(AllOf(HasSubstr(" inertial samples from 2"),
                                                    HasSubstr(": a value is not finite"))));
  EXPECT_THAT(said({"jump@imu:2:3,by=3"}), Contains(HasSubstr(": stamped later than delivered")));
  EXPECT_THAT(said({"jump@imu:2:end,by=-1"}), Contains(HasSubstr(" inertial samples since 2")))
      << "and it goes on";
  EXPECT_THAT(said({}), Contains(HasSubstr("stereo refuses "))) << "there is nothing to see";
  EXPECT_THAT(said({"duplicated@imu"}), Not(Contains(HasSubstr(" inertial samples "))));
}

TEST(FaultRefusals, AnInertialClockThatIsRightAgainIsBelievedAgain) {
  const Driven clean = with_faults({}, 8.0);
  for (const char* fault : {"jump@imu:1:2,by=0.05", "jump@imu:1:2,by=-0.05"}) {
    const Driven r = with_faults({fault}, 8.0);
    EXPECT_LE(r.refused("fusion", "the sensor's clock has fallen back"), 200u) << fault;
    EXPECT_EQ(r.states.back().imu_stamp, clean.states.back().imu_stamp) << fault;
  }
}

TEST(FaultRefusals, NanIsCountedSampleBySample) {
  const Driven r = with_faults({"nan@imu:1:1", "nan@gnss:0:1.5"});
  expect_healthy(r);
  EXPECT_EQ(r.faults.at(0).struck, 100u);
  EXPECT_EQ(r.faults.at(1).struck, 2u);
  EXPECT_EQ(r.refused("fusion", "a value is not finite"), 102u);
  EXPECT_EQ(r.states.front().status, NavStatus::uninitialized);
  EXPECT_NE(r.states.back().status, NavStatus::uninitialized) << "the third fix starts it";
}

TEST(FaultRefusals, DuplicatedAndReorderedInertialSamplesChangeNoState) {
  const Driven clean = with_faults({}), twice = with_faults({"duplicated@imu"}),
               reordered = with_faults({"reordered@imu"});
  EXPECT_EQ(twice.faults.at(0).struck, 400u);
  EXPECT_EQ(twice.refused("fusion", "duplicate"), 400u);
  EXPECT_EQ(twice.channels.at("NAV_STATE").hash, clean.channels.at("NAV_STATE").hash);
  EXPECT_EQ(twice.channels.at("IMU").count, 800u);
  EXPECT_EQ(reordered.states.back().imu_stamp, clean.states.back().imu_stamp) << "none is lost";
  EXPECT_EQ(reordered.states.back().position_enu, clean.states.back().position_enu)
      << "in the order of stamps they are the same";
}

TEST(FaultRefusals, OneSensorsClockDoesNotTakeTheStateDown) {
  for (const char* fault : {"jump@imu:1,by=1.5", "jump@imu:1,by=3", "jump@imu:1,by=100",
                            "jump@camera:1,by=3", "jump@imu:1,by=-3600"}) {
    const Driven r = with_faults({fault});
    expect_healthy(r);
    EXPECT_NE(r.states.back().status, NavStatus::uninitialized) << fault;
    EXPECT_EQ(r.refused("fusion", "restart: the clock jumped"), 0u) << fault;
  }
}

TEST(FaultRefusals, AnAheadClockIsRefusedSampleBySample) {
  const Driven r = with_faults({"jump@imu:1:1,by=3"});
  EXPECT_EQ(r.faults.at(0).struck, 100u);
  EXPECT_EQ(r.refused("fusion", "stamped later than delivered"), 100u);
}

}  // namespace
}  // namespace maploop::vehicle
