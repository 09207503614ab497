// Tests response times against hand-made cases and against simulated schedules.
#include "tools/analyze/response_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace maploop::analyze {
namespace {

Task task(int priority, double period, double execution) {
  return {"", priority, {}, period, execution, 0.0, {}};
}

TEST(ResponseTimes, OnOneCpuAreThoseOfTheTextbook) {
  const std::vector<double> r =
      response_times({task(3, 4.0, 1.0), task(2, 6.0, 2.0), task(1, 12.0, 3.0)}, 1);
  EXPECT_DOUBLE_EQ(r[0], 1.0);
  EXPECT_DOUBLE_EQ(r[1], 3.0);
  EXPECT_DOUBLE_EQ(r[2], 10.0) << "three steps of the first, two of the second";
}

TEST(ResponseTimes, BlockingIsOnTop) {
  Task held_up = task(1, 10.0, 2.0);
  held_up.blocking = 0.5;
  EXPECT_DOUBLE_EQ(response_times({held_up}, 1)[0], 2.5);
}

TEST(ResponseTimes, AStepThatWasHeldUpComesSoonerBeforeTheNext) {
  std::vector<Task> tasks{task(2, 10.0, 6.0), task(1, 30.0, 3.0)};
  EXPECT_DOUBLE_EQ(response_times(tasks, 1)[1], 9.0);
  tasks[0].blocking = 2.0;
  EXPECT_DOUBLE_EQ(response_times(tasks, 1)[1], 15.0) << "twice within 9 ms";
}

TEST(ResponseTimes, ALongStepOnAnotherCpuDelaysOnlyWhileThatOneIsTakenToo) {
  const std::vector<double> r =
      response_times({task(3, 100.0, 1.0), task(2, 100.0, 30.0), task(1, 100.0, 20.0)}, 2);
  EXPECT_DOUBLE_EQ(r[1], 30.0) << "one other thread cannot take both";
  EXPECT_DOUBLE_EQ(r[2], 21.0) << "both are taken for 1 ms at most";
}

TEST(ResponseTimes, AreUnboundedWhereOthersTakeAllTheTime) {
  const std::vector<double> r = response_times({task(2, 2.0, 2.0), task(1, 100.0, 1.0)}, 1);
  EXPECT_DOUBLE_EQ(r[0], 2.0);
  EXPECT_TRUE(std::isinf(r[1]));
}

TEST(ResponseTimes, ThreadsOnOtherCpusDoNotDelay) {
  std::vector<Task> tasks{task(2, 10.0, 6.0), task(1, 20.0, 5.0)};
  EXPECT_DOUBLE_EQ(response_times(tasks, 1)[1], 17.0);
  tasks[0].cpus = {0};
  tasks[1].cpus = {1};
  EXPECT_DOUBLE_EQ(response_times(tasks, 2)[1], 5.0);
}

TEST(ResponseTimes, AResultThatComesLateReleasesTwoStepsCloseTogether) {
  // The second is released by the first, which ends after 1 to 9 ms: twice within 10 ms.
  std::vector<Task> tasks{task(3, 10.0, 9.0), task(2, 10.0, 0.5), task(1, 100.0, 0.1)};
  const double apart = response_times(tasks, 4)[2];
  tasks[1].after = {0};
  EXPECT_GE(response_times(tasks, 4)[2], apart);
}

// Returns the longest response of each task, released at all multiples of its period after an
// offset, by running the tasks of the highest priorities in each unit of time.
std::vector<double> simulated(const std::vector<Task>& tasks, const std::vector<int>& offsets,
                              int cpus, int end) {
  struct Step {
    std::size_t task;
    int released, left;
  };
  std::vector<Step> waiting;
  std::vector<double> longest(tasks.size(), 0.0);
  for (int now = 0; now < end; ++now) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const int since = now - offsets[i];
      if (since >= 0 && since % static_cast<int>(tasks[i].period) == 0)
        waiting.push_back({i, now, static_cast<int>(tasks[i].execution)});
    }
    std::stable_sort(waiting.begin(), waiting.end(), [&](const Step& a, const Step& b) {
      return tasks[a.task].priority > tasks[b.task].priority;
    });
    for (std::size_t k = 0; k < std::min(waiting.size(), static_cast<std::size_t>(cpus)); ++k) {
      Step& step = waiting[k];
      if (--step.left == 0)
        longest[step.task] = std::max(longest[step.task], now + 1.0 - step.released);
    }
    std::erase_if(waiting, [](const Step& step) { return step.left == 0; });
  }
  return longest;
}

TEST(ResponseTimes, NoSimulatedScheduleExceedsThem) {
  std::mt19937 random(1);
  int bounded = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const int cpus = 1 + trial % 3;
    const int of_one_priority = 1 + trial % 2;
    std::vector<Task> tasks;
    std::vector<int> offsets;
    for (int i = 0; i < 4 + trial % 4; ++i) {
      const int period = 5 + static_cast<int>(random() % 40);
      const int execution = 1 + static_cast<int>(random() % static_cast<unsigned>(period / 3));
      tasks.push_back(task(10 - i / of_one_priority, period, execution));
      offsets.push_back(static_cast<int>(random() % 20));
    }
    const std::vector<double> bound = response_times(tasks, cpus);
    const std::vector<double> seen = simulated(tasks, offsets, cpus, 2000);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      // A step that ends after its successor's release is beyond what the analysis is for.
      const bool known = std::all_of(tasks.begin(), tasks.end(), [&](const Task& t) {
        return t.priority < tasks[i].priority ||
               bound[static_cast<std::size_t>(&t - tasks.data())] <= t.period;
      });
      if (!known) continue;
      ++bounded;
      EXPECT_LE(seen[i], bound[i] + 1e-6) << "trial " << trial << ", task " << i;
    }
  }
  EXPECT_GT(bounded, 1200);
}

}  // namespace
}  // namespace maploop::analyze
