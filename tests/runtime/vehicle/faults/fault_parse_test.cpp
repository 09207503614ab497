// Tests how a fault is written, and the error of one that is written wrongly.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/faults/fault_rules.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

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
  EXPECT_EQ(f.by, 0.05);
  EXPECT_EQ(f.share, 0.25);
  EXPECT_EQ(f.seed, 7u);
}

TEST(FaultParse, EveryKindHasItsTargetsAndDefaults) {
  EXPECT_EQ(parse_fault("late@velodyne").by, 0.2);
  EXPECT_EQ(parse_fault("duplicated@gnss").by, 0.001);
  EXPECT_EQ(parse_fault("reordered@camera:1:end").length, std::nullopt);
  EXPECT_EQ(parse_fault("jump@imu,by=-3600").by, -3600.0);
  EXPECT_EQ(parse_fault("jump@imu").by, 1.0);
  EXPECT_EQ(parse_fault("nan@velodyne").kind, FaultKind::nan);
  EXPECT_EQ(parse_fault("frozen@imu:15:2").kind, FaultKind::frozen);
  EXPECT_EQ(parse_fault("black@camera").kind, FaultKind::black);
  EXPECT_EQ(parse_fault("garbage@camera").kind, FaultKind::garbage);
  EXPECT_EQ(parse_fault("slow@stereo").by, 0.1);
  EXPECT_EQ(parse_fault("slow@fusion:1").target, FaultTarget::fusion);
  EXPECT_EQ(parse_fault("slow@ppp").target, FaultTarget::ppp);
  EXPECT_EQ(parse_fault("broken@mapmatch:1").kind, FaultKind::broken);
  EXPECT_EQ(parse_fault("hog@cpu:1:2").threads, 2);
  EXPECT_EQ(parse_fault("hog@cpu:1:2,threads=4").threads, 4);
}

TEST(FaultParse, TheDefaultOfAKindIsThatOfItsTarget) {
  EXPECT_EQ(parse_fault("bias@gyro").by, 0.5);
  EXPECT_EQ(parse_fault("bias@gnss").by, 10.0);
  EXPECT_EQ(parse_fault("noise@velodyne").by, 0.2);
  EXPECT_EQ(parse_fault("spoofed@gnss:5,by=-2").by, -2.0);
  EXPECT_EQ(parse_fault("skewed@imu").by, 200.0);
  EXPECT_EQ(parse_fault("scale@wheel").target, FaultTarget::wheel);
  EXPECT_EQ(parse_fault("drift@accelerometer:3").target, FaultTarget::accelerometer);
}

TEST(FaultParse, EveryRuleOfTheTableIsUnderstood) {
  for (const FaultRule& rule : fault_rules::all) {
    for (const FaultTarget target : rule.targets) {
      const std::string text =
          std::string(rule.name) + '@' + std::string(target_name(target)) + ":1:2";
      const Fault fault = parse_fault(text);
      EXPECT_EQ(fault.kind, rule.kind) << text;
      EXPECT_EQ(fault.target, target) << text;
      EXPECT_EQ(fault.by, rule.default_by) << text;
      EXPECT_LE(rule.default_by, rule.largest_by) << text;
    }
  }
}

TEST(FaultParse, ThePageIsMadeFromTheTable) {
  std::ostringstream page;
  page << std::ifstream(maploop::testing::source("runtime/vehicle/FAULTS.md")).rdbuf();
  EXPECT_EQ(page.str(), fault_page()) << "write fault_page() to runtime/vehicle/FAULTS.md:\n"
                                      << fault_page();
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
           {"bias@imu", "it applies to gyro, accelerometer, gnss"},
           {"noise@camera", "it applies to gyro, accelerometer, gnss, velodyne"},
           {"scale@wheel,by=11", "from -10 to 10"},
           {"rain@velodyne,by=-0.1", "from 0 to 1"},
           {"dimmed@camera,by=1.1", "from 0 to 1"},
           {"bumped@imu", "it applies to camera, velodyne"},
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
