#include "tools/analyze/response_time.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace maploop::analyze {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr int most_rounds = 1000;

bool may_share(const Task& a, const Task& b) {
  return a.cpus.empty() || b.cpus.empty() ||
         std::any_of(a.cpus.begin(), a.cpus.end(), [&](int cpu) {
           return std::find(b.cpus.begin(), b.cpus.end(), cpu) != b.cpus.end();
         });
}

// The latest end of the tasks that release one.
double jitter_of(const Task& task, const std::vector<double>& response) {
  double jitter = 0.0;
  for (const std::size_t before : task.after) jitter = std::max(jitter, response[before]);
  return jitter;
}

// The work that a task brings into a time. On several CPUs a step that was released before it may
// still be running at its beginning.
double work(const Task& task, double jitter, double response, double time, int cpus) {
  const double earlier = cpus > 1 ? std::max(0.0, response - task.execution) : task.blocking;
  return std::ceil((time + jitter + earlier) / task.period) * task.execution;
}

// The longest time for which all CPUs can be taken by tasks that bring this work, each of them on
// one CPU at a time.
double longest_taken(std::vector<double> works, int cpus) {
  std::sort(works.begin(), works.end(), std::greater<>());
  double rest = std::accumulate(works.begin(), works.end(), 0.0);
  double longest = rest / cpus;
  // The largest ones have a CPU each, the rest share what is left.
  for (std::size_t apart = 0; apart < works.size() && cpus > 1; ++apart) {
    rest -= works[apart];
    longest = std::min(longest, rest / --cpus);
  }
  return std::max(0.0, longest);
}

double response_of(std::size_t i, const std::vector<Task>& tasks,
                   const std::vector<double>& response, int all_cpus) {
  const Task& task = tasks[i];
  const int cpus = task.cpus.empty() ? all_cpus : static_cast<int>(task.cpus.size());
  const double longest = 100.0 * task.period;
  double time = task.blocking + task.execution;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> others;
    for (std::size_t j = 0; j < tasks.size(); ++j) {
      const bool delays = j != i && tasks[j].priority >= task.priority && may_share(task, tasks[j]);
      if (!delays) continue;
      const double jitter = jitter_of(tasks[j], response);
      if (!std::isfinite(jitter)) return unbounded;
      others.push_back(work(tasks[j], jitter, response[j], time, cpus));
    }
    const double next = task.blocking + task.execution + longest_taken(std::move(others), cpus);
    if (next <= time + 1e-9) return time;
    if (next > longest) return unbounded;
    time = next;
  }
  return unbounded;
}

}  // namespace

std::vector<double> response_times(const std::vector<Task>& tasks, int cpus) {
  std::vector<double> response(tasks.size(), 0.0);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> next(tasks.size());
    for (std::size_t i = 0; i < tasks.size(); ++i) next[i] = response_of(i, tasks, response, cpus);
    if (next == response) return response;
    response = std::move(next);
  }
  return std::vector<double>(tasks.size(), unbounded);
}

}  // namespace maploop::analyze
