#include "runtime/core/periodic.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace maploop::runtime {
namespace {

using std::chrono::milliseconds;

TEST(Periodic, TheFirstTickIsTheMultipleAtOrAfter) {
  const Duration period = milliseconds(10);
  const Time on = from_nanoseconds(1'317'042'651'170'000'000);
  EXPECT_EQ(first_tick(on, period), on);
  EXPECT_EQ(first_tick(on + Duration(1), period), on + period);
  EXPECT_EQ(first_tick(on - Duration(1), period), on);
}

TEST(Periodic, TicksAreExactMultiplesAndNoneIsLeftOut) {
  DataClock clock = DataClock::paced(10.0);
  const Time start = from_nanoseconds(1'317'042'651'174'740'992);
  clock.start(start);
  std::vector<Time> ticks;
  run_periodic(clock, start, milliseconds(10), {}, [&](Time t) {
    ticks.push_back(t);
    // One tick takes longer than five periods: those behind it follow at once.
    if (ticks.size() == 3) std::this_thread::sleep_for(milliseconds(6));
    return ticks.size() < 20;
  });
  ASSERT_EQ(ticks.size(), 20u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i], first_tick(start, milliseconds(10)) + i * milliseconds(10));
  }
}

TEST(Periodic, EndsAtStop) {
  DataClock clock = DataClock::virtual_time();
  std::stop_source stop;
  int ticks = 0;
  run_periodic(clock, Time{}, milliseconds(10), stop.get_token(), [&](Time) {
    if (++ticks == 5) stop.request_stop();
    return true;
  });
  EXPECT_EQ(ticks, 5);
}

}  // namespace
}  // namespace maploop::runtime
