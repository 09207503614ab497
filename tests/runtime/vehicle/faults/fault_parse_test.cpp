// Tests how a fault is written, and the error of one that is written wrongly.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault.h"
#include "tests/support/error_of.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(FaultParse, AKindAndATargetAreEnough) {
  const Fault f = parse_fault("lost@camera");
  EXPECT_EQ(f.text, "lost@camera");
  EXPECT_EQ(f.kind, FaultKind::lost);
  EXPECT_EQ(f.target, FaultTarget::camera);
  EXPECT_EQ(f.start, Duration::zero());
  EXPECT_FALSE(f.length);
  EXPECT_EQ(f.share, 1.0);
  EXPECT_EQ(f.seed, 1u);
}

TEST(FaultParse, StartLengthAndKeys) {
  const Fault f = parse_fault("late@imu:2.5:0.75,share=0.25,by=0.05,seed=7");
  EXPECT_EQ(f.kind, FaultKind::late);
  EXPECT_EQ(f.target, FaultTarget::imu);
  EXPECT_EQ(f.start, milliseconds(2500));
  EXPECT_EQ(f.length, milliseconds(750));
  EXPECT_EQ(f.by, milliseconds(50));
  EXPECT_EQ(f.share, 0.25);
  EXPECT_EQ(f.seed, 7u);
}

TEST(FaultParse, EveryKindHasItsTargetsAndDefaults) {
  EXPECT_EQ(parse_fault("late@velodyne").by, milliseconds(200));
  EXPECT_EQ(parse_fault("duplicated@gnss").by, milliseconds(1));
  EXPECT_EQ(parse_fault("reordered@camera:1:end").length, std::nullopt);
  EXPECT_EQ(parse_fault("jump@imu,by=-3600").by, -seconds(3600));
  EXPECT_EQ(parse_fault("jump@imu").by, seconds(1));
  EXPECT_EQ(parse_fault("nan@velodyne").kind, FaultKind::nan);
  EXPECT_EQ(parse_fault("frozen@imu:15:2").kind, FaultKind::frozen);
  EXPECT_EQ(parse_fault("black@camera").kind, FaultKind::black);
  EXPECT_EQ(parse_fault("garbage@camera").kind, FaultKind::garbage);
  EXPECT_EQ(parse_fault("slow@stereo").by, milliseconds(100));
  EXPECT_EQ(parse_fault("slow@fusion:1").target, FaultTarget::fusion);
  EXPECT_EQ(parse_fault("slow@ppp").target, FaultTarget::ppp);
  EXPECT_EQ(parse_fault("broken@mapmatch:1").kind, FaultKind::broken);
  EXPECT_EQ(parse_fault("hog@cpu:1:2").threads, 2);
  EXPECT_EQ(parse_fault("hog@cpu:1:2,threads=4").threads, 4);
}

TEST(FaultParse, WhatIsWrongIsNamedWithWhatIsAllowed) {
  struct Case {
    const char* text;
    const char* named;
  };
  for (const Case& c : std::vector<Case>{
           {"", "KIND@TARGET"},
           {"lost", "camera, velodyne, imu, gnss"},
           {"@camera", "late, lost, duplicated"},
           {"lots@camera", "'lots' is not a kind of fault"},
           {"lost@", "camera, velodyne, imu, gnss"},
           {"lost@radar", "'radar'"},
           {"lost@stereo", "camera, velodyne, imu, gnss"},
           {"nan@camera", "velodyne, imu, gnss"},
           {"black@imu", "it applies to camera"},
           {"slow@camera", "stereo, lidar, ppp, fusion, mapmatch"},
           {"lost@imu:", "START"},
           {"lost@imu:x", "START must be a number from 0 to 1000000, not 'x'"},
           {"lost@imu:-1", "START"},
           {"lost@imu:nan", "START"},
           {"lost@imu:1e300", "START"},
           {"lost@imu: 1", "START"},
           {"lost@imu:1s", "START"},
           {"lost@imu:1:", "LENGTH"},
           {"lost@imu:1:0", "LENGTH must be above 0"},
           {"lost@imu:1:ende", "'ende'"},
           {"lost@imu:1:2:3", "at most START and LENGTH"},
           {"lost@imu,", "no key ''"},
           {"lost@imu,share", "share must be a number"},
           {"lost@imu,share=0", "'share' must be above 0"},
           {"lost@imu,share=1.5", "from 0 to 1"},
           {"lost@imu,share=0.5,share=0.5", "twice"},
           {"lost@imu,seed=0.5", "whole number"},
           {"lost@imu,seed=-1", "seed"},
           {"lost@imu,by=1", "no key 'by'; it has share, seed"},
           {"late@imu,by=11", "from 0 to 10"},
           {"late@imu,by=0", "'by' must not be 0"},
           {"jump@imu,by=0", "'by' must not be 0"},
           {"late@imu,delay=1", "by, share, seed"},
           {"slow@stereo,share=0.5", "it has by"},
           {"slow@stereo,by=2", "from 0 to 1"},
           {"broken@camera", "stereo, lidar, ppp, fusion, mapmatch"},
           {"broken@stereo,share=0.5", "no key 'share'"},
           {"hog@cpu", "needs START:LENGTH"},
           {"hog@cpu:1:end", "needs START:LENGTH"},
           {"hog@cpu:1:61", "at most 60 s"},
           {"hog@cpu:1:2,threads=17", "from 1 to 16"},
           {"hog@cpu:1:2,threads=0", "from 1 to 16"},
       }) {
    EXPECT_THAT(maploop::testing::error_of<std::invalid_argument>([&] { parse_fault(c.text); }),
                AllOf(HasSubstr(c.named), HasSubstr("fault '" + std::string(c.text) + "'")));
  }
}

TEST(FaultParse, TheWindowIsHalfOpen) {
  const Time origin = from_nanoseconds(1'000'000'000'000);
  const FaultWindow w = window(parse_fault("lost@imu:1:2"), origin);
  EXPECT_FALSE(w.contains(origin + seconds(1) - Duration(1)));
  EXPECT_TRUE(w.contains(origin + seconds(1)));
  EXPECT_TRUE(w.contains(origin + seconds(3) - Duration(1)));
  EXPECT_FALSE(w.contains(origin + seconds(3)));
}

TEST(FaultParse, AStartOfZeroHoldsWhatCameBeforeTheFirstImageToo) {
  const Time origin = from_nanoseconds(1'000'000'000'000);
  EXPECT_TRUE(window(parse_fault("lost@imu"), origin).contains(origin - seconds(1)));
  EXPECT_TRUE(window(parse_fault("lost@imu:0:1"), origin).contains(origin - seconds(1)));
  EXPECT_FALSE(window(parse_fault("lost@imu:0:1"), origin).contains(origin + seconds(1)));
  EXPECT_TRUE(window(parse_fault("lost@imu:5:end"), origin).contains(Time::max() - Duration(1)));
}

}  // namespace
}  // namespace maploop::vehicle
