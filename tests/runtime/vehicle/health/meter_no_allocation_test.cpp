// Tests that measuring allocates nothing.
#include <gtest/gtest.h>

#include "runtime/vehicle/health/thread_meter.h"
#include "tests/support/counted_allocations.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;

TEST(MeterNoAllocation, TicksMissesStallsAndTicksLeftOut) {
  const runtime::DataClock clock = runtime::DataClock::paced(1.0);
  ThreadMeter meter(stages::fusion);
  const long before = testing::thread_allocations();
  for (int i = 0; i < 1000; ++i) {
    const MonotonicTime due{i * milliseconds(10)};
    const Time stamp = from_nanoseconds(i);
    meter.woke({stamp, i % 10 == 0 ? 5U : 0U}, clock, due, due + milliseconds(i % 7));
    meter.ran(milliseconds(i % 3));
    meter.latency().record({stamp, milliseconds(i), {{{"running", milliseconds(i)}, {}, {}}}});
    meter.latency().record_shift(milliseconds(i), milliseconds(10));
  }
  const long during = testing::thread_allocations() - before;
  EXPECT_EQ(during, 0);
  EXPECT_EQ(meter.latency().miss_count(), 997u) << "of 2 ms";
  EXPECT_EQ(meter.latency().summary().worst.size(), 10u);
  EXPECT_GT(testing::thread_allocations(), before) << "the counter counts: a summary allocates";
}

}  // namespace
}  // namespace maploop::vehicle
