#include "runtime/vehicle/health_monitor.h"

#include <utility>

namespace maploop::vehicle {

void HealthMonitor::watch(const runtime::Thread& thread, const ThreadMeter& meter) {
  threads_.push_back({&thread, &meter, nullptr});
}

void HealthMonitor::watch(const runtime::Thread& thread, const Meter& lateness) {
  threads_.push_back({&thread, nullptr, &lateness});
}

Health HealthMonitor::health(Time stamp, Duration elapsed, const runtime::DataClock& clock) {
  Health health;
  health.stamp = stamp;
  for (Watched& watched : threads_) {
    ThreadHealth t;
    t.name = watched.thread->name();
    t.scheduling = watched.thread->scheduling();
    t.failure = watched.thread->failure();
    t.cpu = to_seconds(watched.thread->cpu_time());
    if (watched.meter != nullptr) {
      t.left_out = watched.meter->left_out();
      t.shed = watched.meter->shed();
    }
    t.count = watched.count();
    if (elapsed > Duration::zero()) {
      t.rate = static_cast<double>(t.count - watched.seen) / to_seconds(elapsed);
    }
    watched.seen = t.count;
    if (!t.failure.empty()) {
      health.degraded.push_back(t.name + " has ended: " + t.failure +
                                "; its outputs are stale, the rest goes on");
    }
    if (t.scheduling.find("refused") != std::string::npos) {
      health.degraded.push_back(t.name + " runs with scheduling " + t.scheduling);
    }
    health.threads.push_back(std::move(t));
  }
  for (const auto* edge : edges_) {
    RingHealth r = edge->health();
    if (r.lost > 0) {
      health.degraded.push_back("ring " + r.name + " has lost " + std::to_string(r.lost) + " of " +
                                std::to_string(r.pushed) + " samples: its reader is too slow");
    }
    health.rings.push_back(std::move(r));
  }
  if (clock.stalls() > 0) {
    health.degraded.push_back("the data clock was stalled " + std::to_string(clock.stalls()) +
                              " times, " + std::to_string(to_seconds(clock.stalled())) +
                              " s in all: this machine is too slow for this speed, or was busy");
  }
  return health;
}

void HealthMonitor::restart_rates() {
  for (Watched& watched : threads_) watched.seen = 0;
}

Deadlines HealthMonitor::deadlines(Time stamp) const {
  Deadlines deadlines;
  deadlines.stamp = stamp;
  const auto add = [](std::vector<LatencySummary>& to, const std::string& thread,
                      const runtime::Histogram& histogram) {
    if (histogram.count() > 0) to.push_back(histogram.summarize(thread));
  };
  for (const Watched& watched : threads_) {
    const std::string& name = watched.thread->name();
    if (watched.meter == nullptr) {
      add(deadlines.wake_up, name, watched.lateness->histogram());
      continue;
    }
    if (watched.meter->has_deadline()) {
      deadlines.threads.push_back(watched.meter->latency().summary());
    }
    add(deadlines.wake_up, name, watched.meter->wake_up());
    add(deadlines.execution, name, watched.meter->execution());
    add(deadlines.period_jitter, name, watched.meter->period_jitter());
  }
  for (const Meter* path : paths_) deadlines.paths.push_back(path->summary());
  return deadlines;
}

}  // namespace maploop::vehicle
