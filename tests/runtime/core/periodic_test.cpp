#include "runtime/core/periodic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "runtime/core/data_clock.h"

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

TEST(Periodic, ThePhaseShiftsEveryTick) {
  const Duration period = milliseconds(10), phase = milliseconds(3);
  const Time whole = from_nanoseconds(1'317'042'651'170'000'000);
  EXPECT_EQ(first_tick(whole, period, phase), whole + phase);
  EXPECT_EQ(first_tick(whole + phase, period, phase), whole + phase);
  EXPECT_EQ(first_tick(whole + milliseconds(4), period, phase), whole + milliseconds(13));
  EXPECT_EQ(first_tick(Time{}, period, phase), Time{} + phase) << "before the first phase of 1970";
}

// Time advances only when a tick takes some, or when a sleep lasts longer than requested.
class FakeClock {
 public:
  bool sleep_until(Time t, const std::stop_token& stop) const {
    now_ = std::max(now_, t) + oversleep_;
    oversleep_ = {};
    return !stop.stop_requested();
  }
  bool keeps_time(Time) const { return keeps_time_; }
  Time now() const { return now_; }

  void spend(Duration d) { now_ += d; }
  void oversleep_next(Duration d) { oversleep_ = d; }
  void keep_no_time() { keeps_time_ = false; }

 private:
  mutable Time now_{};
  mutable Duration oversleep_{};
  bool keeps_time_ = true;
};

struct Ticked {
  int ms;
  std::uint64_t left_out;
  bool operator==(const Ticked&) const = default;
};

// Runs eight ticks of 10 ms; the one at 20 ms takes 35 ms, the others take no time.
std::vector<Ticked> run_with_a_long_tick(Overrun overrun, FakeClock clock = {}) {
  std::vector<Ticked> ticks;
  run_periodic(clock, Time{}, {milliseconds(10), {}, overrun}, {}, [&](const Tick& tick) {
    const auto since = tick.time.time_since_epoch();
    ticks.push_back({static_cast<int>(since / milliseconds(1)), tick.left_out});
    if (since == milliseconds(20)) clock.spend(milliseconds(35));
    return ticks.size() < 8;
  });
  return ticks;
}

TEST(Periodic, CatchUpRunsEveryTick) {
  const std::vector<Ticked> expected{{0, 0},  {10, 0}, {20, 0}, {30, 0},
                                     {40, 0}, {50, 0}, {60, 0}, {70, 0}};
  EXPECT_EQ(run_with_a_long_tick(Overrun::catch_up), expected);
}

TEST(Periodic, SkipRunsTheNewestThatIsDueAndCountsTheOthers) {
  const std::vector<Ticked> expected{{0, 0},  {10, 0}, {20, 0}, {50, 2},
                                     {60, 0}, {70, 0}, {80, 0}, {90, 0}};
  EXPECT_EQ(run_with_a_long_tick(Overrun::skip), expected);
}

TEST(Periodic, AWakeUpThatIsLateOverrunsAsWell) {
  FakeClock clock;
  std::vector<int> ticks;
  std::uint64_t left_out = 0;
  run_periodic(clock, Time{}, {milliseconds(10), milliseconds(2), Overrun::skip}, {},
               [&](const Tick& tick) {
                 ticks.push_back(static_cast<int>(tick.time.time_since_epoch() / milliseconds(1)));
                 left_out += tick.left_out;
                 if (ticks.size() == 2) clock.oversleep_next(milliseconds(20));
                 return ticks.size() < 4;
               });
  EXPECT_EQ(ticks, (std::vector<int>{2, 12, 42, 52})) << "the tick at 42 was due exactly then";
  EXPECT_EQ(left_out, 2u);
}

TEST(Periodic, WithoutTimeNoTickIsLate) {
  FakeClock virtual_time;
  virtual_time.keep_no_time();
  EXPECT_EQ(run_with_a_long_tick(Overrun::skip, virtual_time),
            run_with_a_long_tick(Overrun::catch_up));
}

TEST(Periodic, TicksAreExactMultiplesAndNoneIsLeftOut) {
  DataClock clock = DataClock::paced(10.0);
  const Time start = from_nanoseconds(1'317'042'651'174'740'992);
  clock.start(start);
  std::vector<Time> ticks;
  run_periodic(clock, start, {milliseconds(10)}, {}, [&](const Tick& tick) {
    ticks.push_back(tick.time);
    // One tick takes longer than five periods: those after it follow at once.
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
  run_periodic(clock, Time{}, {milliseconds(10)}, stop.get_token(), [&](const Tick&) {
    if (++ticks == 5) stop.request_stop();
    return true;
  });
  EXPECT_EQ(ticks, 5);
}

}  // namespace
}  // namespace maploop::runtime
