#include "runtime/vehicle/health/health_monitor.h"

#include <fmt/format.h>

#include <utility>

namespace maploop::vehicle {

void HealthMonitor::start(Time first, MonotonicTime wall, Time origin) {
  origin_ = origin;
  first_ = first;
  wall_start_ = wall;
}

void HealthMonitor::watch_driver(const runtime::Thread& thread, DriverBase& driver) {
  threads_.push_back({&thread,
                      &driver.meter(),
                      &driver,
                      {},
                      Watchdog(driver.spec(), Watchdog::Kind::driver, first_, wall_start_)});
}

void HealthMonitor::watch_stage(const StageSpec& stage, const runtime::Thread& thread,
                                const ThreadMeter& meter, std::vector<runtime::EdgeBase*> inputs) {
  threads_.push_back({&thread, &meter, nullptr, std::move(inputs),
                      Watchdog(stage, Watchdog::Kind::fed, first_, wall_start_)});
}

StageFacts HealthMonitor::facts(const Watched& watched, std::uint64_t count) {
  StageFacts facts;
  facts.count = count;
  if (watched.driver != nullptr) facts.newest = watched.driver->arrivals().last();
  Time furthest_behind = Time::max();
  for (const runtime::EdgeBase* input : watched.inputs) {
    const Time promised = input->promised();
    const RingHealth ring = input->health();
    facts.waiting += ring.held;
    if (promised < furthest_behind) {
      furthest_behind = promised;
      facts.waits_for = ring.held == 0 ? ring.name : "";
    }
  }
  return facts;
}

Health HealthMonitor::health(Time stamp, Duration elapsed, const runtime::DataClock& clock,
                             const runtime::RealtimeReport& readiness) {
  Health health;
  health.stamp = stamp;
  const auto say = [&health](std::string sentence) {
    if (!sentence.empty()) health.degraded.push_back(std::move(sentence));
  };
  for (const std::string_view sensor : missing_) {
    say(fmt::format("{}: there is none; the rest goes without", sensor));
  }
  const MonotonicTime now = runtime::monotonic_now();
  for (Watched& watched : threads_) {
    ThreadHealth t;
    t.name = watched.thread->name();
    t.scheduling = watched.thread->settings().front().granted;
    t.failure = watched.thread->failure();
    t.cpu = to_seconds(watched.thread->cpu_time());
    t.left_out = watched.meter->left_out();
    t.count = watched.meter->count();
    if (elapsed > Duration::zero()) {
      t.rate = static_cast<double>(t.count - watched.seen) / to_seconds(elapsed);
    }
    watched.seen = t.count;
    if (!t.failure.empty()) {
      say(t.name + " has ended: " + t.failure + "; its outputs are stale, the rest goes on");
    }
    for (std::string& wrong : watched.watchdog.look(stamp, now, facts(watched, t.count)))
      say(std::move(wrong));
    if (watched.driver != nullptr) {
      t.shed = watched.driver->shed();
      say(outage_sentence(t.name, watched.driver->arrivals().outages(), origin_));
    }
    health.threads.push_back(std::move(t));
  }
  for (UseWatch* use : uses_) say(use->sentence(origin_));
  for (const auto* edge : edges_) {
    RingHealth r = edge->health();
    if (r.lost > 0) {
      say(fmt::format("ring {} has lost {} of {} samples: its reader {}", r.name, r.lost, r.pushed,
                      edge->abandoned() ? "has ended" : "is too slow"));
    }
    health.rings.push_back(std::move(r));
  }
  for (const MessageSink* output : outputs_) {
    OutputHealth o = output->health();
    if (o.unsent > 0) {
      say(fmt::format(
          "{} did not take {} of {} messages: is the network (ip route get 224.0.0.1) or the disk "
          "(df) gone?",
          o.name, o.unsent, o.sent + o.unsent));
    }
    health.outputs.push_back(std::move(o));
  }
  health.settings = readiness.settings;
  for (const RealtimeSetting& setting : health.settings) {
    if (setting.verdict == Verdict::refused) say(runtime::to_sentence(setting));
  }
  if (clock.stalls() > 0) {
    say(fmt::format(
        "the data clock was stalled {} times, {:f} s in all: this machine is too slow for this "
        "speed, or was busy",
        clock.stalls(), to_seconds(clock.stalled())));
  }
  return health;
}

std::vector<Naming> HealthMonitor::namings(Time now) {
  std::vector<Naming> all;
  for (const Watched& watched : threads_) {
    if (watched.driver == nullptr || watched.driver->spec().min_rate <= 0.0) continue;
    const Duration patience = Watchdog::patience(watched.driver->spec());
    if (const Time named = watched.driver->arrivals().named(now, patience); named != Time{})
      all.push_back({watched.thread->name(), named});
  }
  for (UseWatch* use : uses_) {
    if (auto naming = use->naming()) all.push_back(std::move(*naming));
  }
  return all;
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
