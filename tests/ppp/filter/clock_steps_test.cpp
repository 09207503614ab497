#include "ppp/filter/clock_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace maploop::ppp {
namespace {

// Makes the measurements of eight satellites, whose codes have noise.
std::vector<Measurement> epoch(int t, double code_step, double phase_step) {
  std::vector<Measurement> all;
  for (std::uint8_t n = 1; n <= 8; ++n) {
    Measurement m;
    m.satellite = {System::gps, n};
    const double range = 2.0e7 + 1e5 * n + 500.0 * t;
    m.first = {'1', 'C', 1575.42e6, speed_of_light / 1575.42e6};
    m.second = {'2', 'W', 1227.60e6, speed_of_light / 1227.60e6};
    m.first.code = range + 0.5 * std::sin(n + t) + code_step;
    m.second.code = range + 0.7 * std::sin(2 * n + t) + code_step;
    m.first.phase = range + 3.0 * n + phase_step;
    m.second.phase = range - 5.0 * n + phase_step;
    all.push_back(m);
  }
  return all;
}

TEST(ClockSteps, PhasesFollowTheCodes) {
  ClockSteps steps;
  for (int t = 0; t < 60; ++t) {
    const double step = (t < 20 ? 0 : t < 40 ? 1 : -2) * millisecond_range;
    auto found = epoch(t, step, 0.0);
    const auto as_if_both = epoch(t, step, step);
    steps.repair(found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].first.phase, as_if_both[i].first.phase, 1e-6) << t;
      EXPECT_NEAR(found[i].second.phase, as_if_both[i].second.phase, 1e-6) << t;
      EXPECT_EQ(found[i].first.code, as_if_both[i].first.code);
    }
  }
}

TEST(ClockSteps, NothingElseIsTouched) {
  ClockSteps steps;
  for (int t = 0; t < 30; ++t) {
    // Both step; two satellites slip by a large amount, and one has a wrong code.
    const double both = t < 10 ? 0.0 : millisecond_range;
    auto found = epoch(t, both, both);
    if (t >= 15) found[2].first.phase += 5.0 * millisecond_range;
    if (t >= 15) found[3].first.phase -= 1234.0;
    if (t == 20) found[4].first.code += millisecond_range;
    if (t == 22) found[5].first.phase = found[5].second.phase = 0.0;
    const auto before = found;
    steps.repair(found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].first.phase, before[i].first.phase) << t;
      EXPECT_EQ(found[i].second.phase, before[i].second.phase) << t;
    }
  }
}

std::vector<Measurement> only(std::vector<Measurement> all, std::initializer_list<int> numbers) {
  std::erase_if(all, [&](const Measurement& m) {
    return std::find(numbers.begin(), numbers.end(), m.satellite.number) == numbers.end();
  });
  return all;
}

// Between houses satellites come and go. Those that were away when the codes stepped must not tell
// the same step once more.
TEST(ClockSteps, ASatelliteThatWasAwayDoesNotTellTheStepAgain) {
  ClockSteps steps;
  auto before = epoch(0, 0.0, 0.0);
  steps.repair(before);
  auto at_the_step = only(epoch(1, -millisecond_range, 0.0), {1, 2, 3, 4});
  steps.repair(at_the_step);
  for (int t = 2; t < 6; ++t) {
    // Only such satellites are there.
    auto found = only(epoch(t, -millisecond_range, 0.0), {5, 6, 7, 8});
    const auto as_if_both = only(epoch(t, -millisecond_range, -millisecond_range), {5, 6, 7, 8});
    steps.repair(found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i].first.phase, as_if_both[i].first.phase, 1e-6) << t;
      EXPECT_FALSE(found[i].first.lost_lock) << t;
    }
  }
}

TEST(ClockSteps, AStepThatOnlyOneSatelliteTellsIsALossOfItsLock) {
  ClockSteps steps;
  auto before = epoch(0, 0.0, 0.0);
  steps.repair(before);
  auto alone = only(epoch(1, millisecond_range, 0.0), {1});
  steps.repair(alone);
  EXPECT_TRUE(alone[0].first.lost_lock);
  auto all = epoch(2, millisecond_range, 0.0);  // seven tell the step, which the first has told
  steps.repair(all);
  for (const Measurement& m : all) {
    EXPECT_EQ(m.first.lost_lock, m.satellite.number == 1);
    EXPECT_NEAR(m.first.code - m.first.phase, 0.0, 100.0);
  }
  auto after = epoch(3, millisecond_range, 0.0);
  steps.repair(after);
  for (const Measurement& m : after) EXPECT_FALSE(m.first.lost_lock);
}

}  // namespace
}  // namespace maploop::ppp
