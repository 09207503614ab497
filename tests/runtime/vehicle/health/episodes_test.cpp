#include "runtime/vehicle/health/episodes.h"

#include <gtest/gtest.h>

#include <string>

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time origin = from_nanoseconds(1'000'000'000'000);
constexpr const char* gate = "it contradicts the prediction";

TEST(ArrivalWatch, KeepsAnOutageAfterItsEnd) {
  ArrivalWatch watch;
  watch.start(origin, seconds(1));
  for (int i = 0; i < 300; ++i) {
    if (i < 100 || i >= 200) watch.arrived(origin + i * milliseconds(100));
  }
  EXPECT_EQ(outage_sentence("imu", watch.outages(), origin),
            "imu: silent for 10.1 s from 9.9 s on");
  EXPECT_EQ(watch.last(), origin + milliseconds(29'900));
  watch.arrived(origin + seconds(32));
  EXPECT_EQ(outage_sentence("imu", watch.outages(), origin),
            "imu: silent for 2.1 s from 29.9 s on (2 times, 12.2 s in all; this is the last)");
}

TEST(ArrivalWatch, ReportsNothingForASteadySensorOrOneThatMayPause) {
  ArrivalWatch steady, free;
  steady.start(origin, seconds(1));
  free.start(origin, Duration::zero());
  for (int i = 0; i < 100; ++i) {
    steady.arrived(origin + i * milliseconds(900));
    free.arrived(origin + i * seconds(20));
  }
  EXPECT_EQ(steady.outages().count, 0u);
  EXPECT_EQ(free.outages().count, 0u);
}

TEST(ArrivalWatch, AFirstSampleThatComesLateIsAnOutageFromTheStartOn) {
  ArrivalWatch watch;
  watch.start(origin, seconds(1));
  watch.arrived(origin + seconds(3));
  EXPECT_EQ(outage_sentence("gnss", watch.outages(), origin),
            "gnss: silent for 3.0 s from 0.0 s on");
}

class UseWatchTest : public ::testing::Test {
 protected:
  void note(int from, int to, const char* refused_for) {
    for (int i = from; i < to; ++i) watch_.note(origin + i * milliseconds(10), refused_for);
  }
  UseWatch watch_{"fusion", "inertial samples", seconds(1)};
};

TEST_F(UseWatchTest, ReportsNothingWhereMoreThanHalfIsUsed) {
  for (int i = 0; i < 1000; ++i) note(i, i + 1, i % 5 < 2 ? gate : nullptr);
  EXPECT_EQ(watch_.sentence(origin), "");
}

TEST_F(UseWatchTest, ReportsRefusalsWhileTheyLastAndKeepsThemAfterwards) {
  note(0, 200, nullptr);
  note(200, 501, gate);
  EXPECT_EQ(watch_.sentence(origin),
            "fusion refuses 300 of the last 300 inertial samples since 2.0 s: "
            "it contradicts the prediction");
  note(501, 1001, nullptr);
  EXPECT_EQ(watch_.sentence(origin),
            "fusion refused 300 of 300 inertial samples from 2.0 s to 5.0 s: "
            "it contradicts the prediction");
}

TEST_F(UseWatchTest, NamesTheReasonOfMost) {
  for (int i = 0; i < 101; ++i) note(i, i + 1, i % 10 == 0 ? "a value is not finite" : gate);
  EXPECT_EQ(watch_.sentence(origin),
            "fusion refuses 100 of the last 100 inertial samples since 0.0 s: "
            "it contradicts the prediction");
}

TEST_F(UseWatchTest, JudgesNothingByFewerThanThree) {
  for (int i = 0; i < 3; ++i) watch_.note(origin + i * seconds(10), gate);
  EXPECT_EQ(watch_.sentence(origin), "");
  watch_.note(origin + seconds(30), gate);
  EXPECT_NE(watch_.sentence(origin), "");
}

TEST_F(UseWatchTest, ItsNamingIsWhenItWasFirstNoticed) {
  EXPECT_FALSE(watch_.naming());
  note(0, 300, nullptr);
  note(300, 650, gate);
  note(650, 2000, nullptr);
  note(2000, 2500, gate);
  ASSERT_TRUE(watch_.naming());
  EXPECT_EQ(watch_.naming()->what, "fusion refuses inertial samples");
  EXPECT_EQ(watch_.naming()->at, origin + seconds(4)) << "after a second of refusals";
}

TEST(DoubtWatch, SaysThatItDoubtsWhatItUses) {
  UseWatch watch("fusion", "GNSS fixes", seconds(1), doubts);
  for (int i = 0; i < 8; ++i) watch.note(origin + seconds(i), i < 2 ? nullptr : gate);
  EXPECT_EQ(watch.sentence(origin).rfind("fusion doubts ", 0), 0u);
  EXPECT_EQ(watch.naming()->what, "fusion doubts GNSS fixes");
}

TEST(ArrivalWatch, ASilenceIsNamedAlsoBeforeItsEnd) {
  ArrivalWatch watch;
  watch.start(origin, seconds(1));
  watch.arrived(origin + milliseconds(500));
  EXPECT_EQ(watch.named(origin + seconds(1), seconds(1)), Time{});
  EXPECT_EQ(watch.named(origin + seconds(3), seconds(1)), origin + milliseconds(1500));
  watch.arrived(origin + seconds(4));
  watch.arrived(origin + milliseconds(4500));
  EXPECT_EQ(watch.named(origin + seconds(5), seconds(1)), origin + milliseconds(1500));
}

}  // namespace
}  // namespace maploop::vehicle
