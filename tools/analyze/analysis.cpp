#include "tools/analyze/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "runtime/vehicle/graph/ring_specs.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "tools/analyze/response_time.h"

namespace maploop::analyze {
namespace {

using vehicle::StageSpec;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

const StageSpec* stage_of(const std::string& name) {
  const auto found = std::find_if(vehicle::stages::all.begin(), vehicle::stages::all.end(),
                                  [&](const StageSpec& stage) { return stage.name == name; });
  return found != vehicle::stages::all.end() ? &*found : nullptr;
}

// A thread that is analyzed, with how it is scheduled.
struct Thread {
  Promise promise;
  Task task;
};

bool goes_first(const runtime::Scheduling& scheduling) {
  using enum runtime::SchedulingPolicy;
  return scheduling.policy == fifo || scheduling.policy == rr || scheduling.policy == deadline;
}

// Above all of fifo and rr.
int priority_of(const runtime::Scheduling& scheduling) {
  return scheduling.policy == runtime::SchedulingPolicy::deadline ? 100 : scheduling.priority;
}

Thread thread_of(const ThreadHealth& health, const StageSpec& stage,
                 const runtime::Scheduling& scheduling, const profile::Profile& run,
                 const BoundParameters& parameters) {
  Thread thread;
  Promise& p = thread.promise;
  p.name = health.name;
  p.scheduling = runtime::to_string(scheduling);
  const double steps = static_cast<double>(health.count);
  p.period = stage.period > Duration::zero() ? to_milliseconds(stage.period)
                                             : 1e3 * run.health.elapsed / steps;
  const LatencySummary* const execution = profile::find(run.execution, health.name);
  if (execution == nullptr) {
    throw std::invalid_argument(
        fmt::format("the run does not say how long the steps of '{}' took, because an older "
                    "version made it: record it again",
                    health.name));
  }
  p.execution = execution_bound(*execution, parameters);
  const profile::Latency* const response = profile::find(run.threads, health.name);
  p.measured = response != nullptr ? to_milliseconds(response->max) : unknown;
  p.deadline = to_milliseconds(stage.deadline);
  const LatencySummary* const late = profile::find(run.wake_up, health.name);
  thread.task = {
      p.name,   priority_of(scheduling), scheduling.cpus,
      p.period, p.execution.bound,       late != nullptr ? to_milliseconds(late->max) : 0.0,
      {}};
  return thread;
}

// Lets each thread be released by the results of those that send it samples, unless it has a rate
// of its own.
void join(std::vector<Task>& tasks) {
  const auto index = [&](std::string_view name) {
    return static_cast<std::size_t>(
        std::find_if(tasks.begin(), tasks.end(), [&](const Task& t) { return t.name == name; }) -
        tasks.begin());
  };
  const auto add = [&](const auto& ring) {
    const std::size_t from = index(ring.from.name), to = index(ring.to.name);
    if (from < tasks.size() && to < tasks.size() && ring.to.period == Duration::zero())
      tasks[to].after.push_back(from);
  };
  std::apply([&](const auto&... ring) { (add(ring), ...); }, vehicle::rings::all);
}

// The kernel may hold up any thread as long as it held up one of the same or a higher priority. One
// of a lower priority waited for others as well.
void share_blocking(std::vector<Task>& tasks) {
  double longest = 0.0;
  for (auto task = tasks.begin(); task != tasks.end();) {
    const auto lower =
        std::find_if(task, tasks.end(), [&](const Task& t) { return t.priority < task->priority; });
    for (auto t = task; t != lower; ++t) longest = std::max(longest, t->blocking);
    for (; task != lower; ++task) task->blocking = longest;
  }
}

// Returns what would let the task meet its deadline.
std::string remedy(const std::vector<Task>& tasks, std::size_t i, const Analysis& a) {
  const Promise& p = a.threads[i];
  const int cpus = a.cpus;
  const double blocking = tasks[i].blocking;
  const auto kept = [&](const std::vector<Task>& changed, int n) {
    return response_times(changed, n)[i] <= p.deadline;
  };
  std::vector<Task> unblocked = tasks;
  for (Task& task : unblocked) task.blocking = 0.0;
  if (p.execution.bound > p.deadline)
    return fmt::format("its own step takes up to {:.3f} ms", p.execution.bound);
  if (kept(unblocked, cpus) || p.execution.bound + blocking > p.deadline) {
    return fmt::format(
        "its step takes up to {:.3f} ms, and the kernel wakes threads up to {:.3f} ms late: see "
        "maploop doctor",
        p.execution.bound, blocking);
  }
  std::vector<Task> first = tasks;
  for (const Task& task : tasks) first[i].priority = std::max(first[i].priority, task.priority + 1);
  if (kept(first, cpus)) return fmt::format("priority {} would do", first[i].priority);
  if (cpus > 1) {
    std::vector<Task> apart = tasks;
    for (Task& task : apart) {
      task.cpus.clear();
      for (int cpu = 0; cpu < cpus - 1; ++cpu) task.cpus.push_back(cpu);
    }
    apart[i].cpus = {cpus - 1};
    if (kept(apart, cpus)) {
      return fmt::format("a CPU of its own would do: cpus = [{}], and the others elsewhere",
                         cpus - 1);
    }
  }
  constexpr int most_cpus = 16;
  for (int more = cpus + 1; more <= most_cpus; ++more) {
    if (kept(tasks, more)) return fmt::format("{} CPUs would do", more);
  }
  return "no priority, and no number of CPUs up to 16, would do";
}

}  // namespace

Analysis analyze(const profile::Profile& run, const vehicle::SchedulingParameters& scheduling,
                 const AnalysisParameters& parameters) {
  if (run.virtual_time()) {
    throw std::invalid_argument(
        "the run was on virtual time (--lockstep), where no thread waits for a time: record one "
        "without it");
  }
  std::vector<Thread> threads;
  for (const ThreadHealth& health : run.health.threads) {
    const StageSpec* stage = stage_of(health.name);
    if (stage == nullptr || health.count == 0) continue;
    const runtime::Scheduling& how = vehicle::scheduling_of(scheduling, *stage);
    if (goes_first(how))
      threads.push_back(thread_of(health, *stage, how, run, parameters.execution));
  }
  std::stable_sort(threads.begin(), threads.end(), [](const Thread& a, const Thread& b) {
    return a.task.priority > b.task.priority;
  });
  Analysis analysis;
  analysis.cpus = parameters.cpus;
  std::vector<Task> tasks;
  for (const Thread& thread : threads) {
    tasks.push_back(thread.task);
    analysis.utilization += thread.task.execution / thread.task.period / parameters.cpus;
    analysis.blocking = std::max(analysis.blocking, thread.task.blocking);
  }
  join(tasks);
  share_blocking(tasks);
  const std::vector<double> response = response_times(tasks, parameters.cpus);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    Promise& p = threads[i].promise;
    // Longer in the run if the step had to wait for the one before, or for an input.
    p.response = std::max(response[i], p.measured);
    analysis.threads.push_back(p);
  }
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const Promise& p = analysis.threads[i];
    if (!p.kept()) {
      analysis.advice.push_back(fmt::format("{}: {:.0f} ms cannot be promised; {}.", p.name,
                                            p.deadline, remedy(tasks, i, analysis)));
    }
  }
  return analysis;
}

}  // namespace maploop::analyze
