#include "runtime/core/data_clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace maploop::runtime {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

const Time t0 = from_nanoseconds(1'317'042'651'000'000'000);

TEST(DataClock, DueTimesFollowTheSpeed) {
  for (const double speed : {0.5, 1.0, 4.0}) {
    DataClock clock = DataClock::paced(speed);
    clock.start(t0);
    const Duration apart = clock.due(t0 + milliseconds(100)) - clock.due(t0);
    EXPECT_EQ(apart.count(), std::llround(100e6 / speed));
  }
}

TEST(DataClock, NeverWakesBeforeTheStampIsDue) {
  DataClock clock = DataClock::paced(2.0);
  clock.start(t0);
  const Time t = t0 + milliseconds(30);
  EXPECT_TRUE(clock.sleep_until(t, {}));
  EXPECT_GE(monotonic_now(), clock.due(t));
  EXPECT_GE(clock.now(), t);
}

TEST(DataClock, VirtualTimeNeverSleepsAndNeverStalls) {
  DataClock clock = DataClock::virtual_time();
  clock.start(t0);
  EXPECT_TRUE(clock.sleep_until(t0 + std::chrono::hours(1000), {}));
  EXPECT_FALSE(clock.stall(t0, monotonic_now() + std::chrono::hours(1)));
  EXPECT_EQ(clock.stalls(), 0u);
}

TEST(DataClock, StopEndsALongSleep) {
  DataClock clock = DataClock::paced(1.0);
  clock.start(t0);
  std::stop_source stop;
  bool slept_through = true;
  std::thread sleeper(
      [&] { slept_through = clock.sleep_until(t0 + std::chrono::hours(1), stop.get_token()); });
  stop.request_stop();
  sleeper.join();
  EXPECT_FALSE(slept_through);
}

TEST(DataClock, AStallMovesEverythingLaterOnce) {
  DataClock clock = DataClock::paced(1.0);
  clock.start(t0);
  const Time t = t0 + milliseconds(10);
  const MonotonicTime before = clock.due(t);
  EXPECT_TRUE(clock.stall(t, before + milliseconds(20)));
  EXPECT_EQ(clock.due(t), before + milliseconds(20));
  // A second thread that was delayed by the same wait does not stall the clock again.
  EXPECT_FALSE(clock.stall(t, before + milliseconds(20)));
  EXPECT_EQ(clock.stalls(), 1u);
  EXPECT_EQ(clock.stalled(), milliseconds(20));
}

TEST(DataClock, LatenessWithinTheToleranceIsNoStall) {
  DataClock clock = DataClock::paced(1.0);
  clock.start(t0);
  EXPECT_FALSE(clock.stall(t0, clock.due(t0) + DataClock::tolerance));
  EXPECT_EQ(clock.stalled(), Duration::zero());
}

TEST(DataClock, ALiveOneBeginsAtAGivenMomentAndIsNeverStalled) {
  DataClock clock = DataClock::live();
  const MonotonicTime due = monotonic_now() + milliseconds(5);
  clock.start(t0, due);
  EXPECT_TRUE(DataClock(clock).is_live());
  EXPECT_FALSE(DataClock::paced(1.0).is_live());
  EXPECT_EQ(clock.due(t0 + milliseconds(7)), due + milliseconds(7));
  EXPECT_FALSE(clock.stall(t0, due + milliseconds(50)));
  EXPECT_EQ(clock.stalls(), 0u);
  EXPECT_EQ(clock.due(t0), due);
}

TEST(DataClock, RefusesASpeedThatGoesNowhere) {
  EXPECT_THROW(DataClock::paced(0.0), std::invalid_argument);
  EXPECT_THROW(DataClock::paced(-1.0), std::invalid_argument);
  EXPECT_THROW(DataClock::paced(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(DataClock::paced(std::numeric_limits<double>::infinity()), std::invalid_argument);
}

TEST(DataClock, GoesFromAPauseToTheNextAndNoFurther) {
  DataClock clock = DataClock::paced(10.0);
  clock.start(t0);
  clock.pause();
  const Time next = clock.now() + milliseconds(20);
  clock.resume_until(next);
  EXPECT_TRUE(clock.sleep_until(next, {}));
  std::this_thread::sleep_for(milliseconds(1));
  EXPECT_EQ(clock.now(), next);
  EXPECT_TRUE(clock.paused());
  clock.resume();
  EXPECT_TRUE(clock.sleep_until(next + milliseconds(10), {}));
}

// The pausing thread may be preempted at any place; so it pauses often, and beside a busy thread.
TEST(DataClock, NothingThatWasReleasedIsLaterThanThePause) {
  DataClock clock = DataClock::paced(1.0);
  const Time first = t0;
  clock.start(first);
  std::atomic<Time> released{first};
  std::jthread driver([&](const std::stop_token& stop) {
    for (Time t = first; clock.sleep_until(t, stop); t += microseconds(10)) released = t;
  });
  for (int i = 0; i < 2000; ++i) {
    clock.pause();
    EXPECT_TRUE(clock.pause_set());
    const Time held = clock.now();
    std::this_thread::yield();
    ASSERT_LE(released.load(), held) << "at pause " << i;
    clock.resume();
    std::this_thread::yield();
  }
}

TEST(DataClock, AStallNoticedAfterAPauseDoesNotUnsetIt) {
  DataClock clock = DataClock::paced(1.0);
  clock.start(t0);
  clock.pause();
  EXPECT_TRUE(clock.stall(t0, monotonic_now() + std::chrono::seconds(100)));
  EXPECT_FALSE(clock.paused()) << "time stands before the pause";
  EXPECT_TRUE(clock.pause_set());
  clock.resume();
  EXPECT_FALSE(clock.pause_set());
}

}  // namespace
}  // namespace maploop::runtime
