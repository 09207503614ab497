#include "tools/analyze/response_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// The work that a task with this jitter of release brings into a time. On several CPUs a step that
// was released before may still be running at its beginning.
double work(const Task& task, double jitter, double time, int cpus) {
  const double carried = cpus > 1 ? task.execution : 0.0;
  return std::ceil((time + jitter) / task.period) * task.execution + carried;
}

// The latest end of the tasks that release one.
double jitter_of(const Task& task, const std::vector<double>& response) {
  double jitter = 0.0;
  for (const std::size_t before : task.after) jitter = std::max(jitter, response[before]);
  return jitter;
}

double response_of(std::size_t i, const std::vector<Task>& tasks,
                   const std::vector<double>& response, int all_cpus, double blocking) {
  const Task& task = tasks[i];
  const int cpus = task.cpus.empty() ? all_cpus : static_cast<int>(task.cpus.size());
  const double longest = 100.0 * task.period;
  double time = blocking + task.execution;
  for (int round = 0; round < most_rounds; ++round) {
    double others = 0.0;
    for (std::size_t j = 0; j < tasks.size(); ++j) {
      const bool delays = j != i && tasks[j].priority >= task.priority && may_share(task, tasks[j]);
      if (!delays) continue;
      const double jitter = jitter_of(tasks[j], response);
      if (!std::isfinite(jitter)) return unbounded;
      const double brought = work(tasks[j], jitter, time, cpus);
      others += cpus > 1 ? std::min(brought, time - task.execution + 1e-6) : brought;
    }
    const double next = blocking + task.execution + others / cpus;
    if (next <= time + 1e-9) return time;
    if (next > longest) return unbounded;
    time = next;
  }
  return unbounded;
}

}  // namespace

std::vector<double> response_times(const std::vector<Task>& tasks, int cpus, double blocking) {
  std::vector<double> response(tasks.size(), 0.0);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> next(tasks.size());
    for (std::size_t i = 0; i < tasks.size(); ++i)
      next[i] = response_of(i, tasks, response, cpus, blocking);
    if (next == response) return response;
    response = std::move(next);
  }
  return std::vector<double>(tasks.size(), unbounded);
}

}  // namespace maploop::analyze
