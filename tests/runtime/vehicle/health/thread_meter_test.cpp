#include "runtime/vehicle/health/thread_meter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace maploop::vehicle {
namespace {

using runtime::DataClock;
using runtime::Histogram;
using runtime::Tick;
using std::chrono::milliseconds;

constexpr Time start = from_nanoseconds(1'317'042'651'000'000'000);
constexpr StageSpec stage{.name = "fusion",
                          .runs = "",
                          .released = "",
                          .period = milliseconds(10),
                          .deadline = milliseconds(2)};

// Records the i-th tick, woken `late` after it was due.
void wake(ThreadMeter& meter, const DataClock& clock, int i, Duration late,
          std::uint64_t left_out = 0) {
  const MonotonicTime due{i * milliseconds(10)};
  meter.woke(Tick{start + i * milliseconds(10), left_out}, clock, due, due + late);
}

Histogram omitted_in(const ThreadMeter& meter) {
  Histogram omitted;
  omitted.merge(meter.latency().summary().omitted);
  return omitted;
}

TEST(ThreadMeter, JitterIsOfThePeriodAndNotOfTheLateness) {
  const DataClock clock = DataClock::paced(1.0);
  ThreadMeter meter(stage);
  for (int i = 0; i < 5; ++i) wake(meter, clock, i, milliseconds(3));
  EXPECT_EQ(meter.wake_up().max(), milliseconds(3));
  EXPECT_EQ(meter.period_jitter().count(), 4u);
  EXPECT_EQ(meter.period_jitter().max(), Duration{}) << "always as late: no jitter";
  wake(meter, clock, 5, milliseconds(7));
  EXPECT_EQ(meter.period_jitter().max(), milliseconds(4));
  wake(meter, clock, 6, milliseconds(2));
  EXPECT_EQ(meter.period_jitter().max(), milliseconds(5)) << "too early after the last one";
}

TEST(ThreadMeter, TicksThatCatchUpHideNothing) {
  const DataClock clock = DataClock::paced(1.0);
  ThreadMeter meter(stage);
  for (int i = 0; i < 5; ++i) wake(meter, clock, i, milliseconds(45 - 10 * i));
  EXPECT_EQ(meter.wake_up().count(), 5u);
  EXPECT_TRUE(meter.latency().summary().omitted.buckets.empty());
}

TEST(ThreadMeter, AStallOfTheDataClockHidesTheTicksThatItDelays) {
  DataClock clock = DataClock::paced(1.0);
  clock.start(start);
  ThreadMeter meter(stage);
  wake(meter, clock, 0, {});
  ASSERT_TRUE(clock.stall(start, clock.due(start) + milliseconds(55)));
  for (int i = 1; i < 4; ++i) wake(meter, clock, i, {});
  const Histogram omitted = omitted_in(meter);
  EXPECT_EQ(omitted.count(), 4u) << "of 45, 35, 25 and 15 ms, once";
  EXPECT_EQ(omitted.max(), milliseconds(45));
  EXPECT_EQ(omitted.min(), milliseconds(15));
}

TEST(ThreadMeter, AtDoubleSpeedThePeriodIsHalfAsLong) {
  DataClock clock = DataClock::paced(2.0);
  clock.start(start);
  ThreadMeter meter(stage);
  ASSERT_TRUE(clock.stall(start, clock.due(start) + milliseconds(21)));
  wake(meter, clock, 0, {});
  const Histogram omitted = omitted_in(meter);
  EXPECT_EQ(omitted.count(), 3u) << "of 16, 11 and 6 ms";
}

TEST(ThreadMeter, TicksLeftOutHaveWaitedToo) {
  const DataClock clock = DataClock::paced(1.0);
  ThreadMeter meter(stage);
  wake(meter, clock, 0, {});
  wake(meter, clock, 4, milliseconds(5), 3);
  const Histogram omitted = omitted_in(meter);
  EXPECT_EQ(meter.left_out(), 3u);
  EXPECT_EQ(omitted.count(), 3u) << "of 35, 25 and 15 ms";
  EXPECT_EQ(omitted.max(), milliseconds(35));
  EXPECT_EQ(omitted.min(), milliseconds(15));
}

TEST(ThreadMeter, IsReadWhileItRecords) {
  const DataClock clock = DataClock::paced(1.0);
  ThreadMeter meter(stage);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int i = 0; i < 50000; ++i) {
      wake(meter, clock, i, Duration(i % 7), i % 100 == 0 ? 2 : 0);
      meter.ran(Duration(i % 5));
      meter.latency().record({start, milliseconds(i % 4), {{{"running", milliseconds(1)}}}});
    }
    done = true;
  });
  std::uint64_t last = 0;
  while (!done) {
    EXPECT_GE(meter.count(), last);
    last = meter.count();
    EXPECT_LE(meter.wake_up().summarize("").p99, Duration(6));
    EXPECT_LE(meter.latency().summary().max, milliseconds(3));
  }
  writer.join();
  EXPECT_EQ(meter.count(), 50000u);
  EXPECT_EQ(meter.left_out(), 1000u);
  EXPECT_EQ(meter.latency().miss_count(), 12500u);
}

}  // namespace
}  // namespace maploop::vehicle
