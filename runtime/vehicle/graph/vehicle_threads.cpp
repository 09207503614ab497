// The vehicle's threads: their start and their end.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/input_limits.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/graph/vehicle_graph.h"
#include "runtime/vehicle/health/process_usage.h"

namespace maploop::vehicle {
namespace {

// Between start() and the first release, so that every thread is up.
constexpr Duration lead = milliseconds(100);

}  // namespace

runtime::Thread& Vehicle::Graph::start_thread(std::deque<runtime::Thread>& threads,
                                              const StageSpec& stage, std::stop_token token,
                                              runtime::Thread::Body body,
                                              std::function<void()> at_end) {
  runtime::Thread& thread = threads.emplace_back(
      std::string(stage.name),
      clock.is_paced() ? scheduling_of(config.scheduling, stage) : runtime::Scheduling{},
      std::move(token), std::move(body), std::move(at_end));
  runtime::append(readiness, thread.settings());
  return thread;
}

void Vehicle::Graph::find_first() {
  std::vector<std::pair<std::string_view, Time>> firsts;
  for (const auto& driver : drivers) {
    if (const auto available = driver->load_first())
      firsts.emplace_back(driver->spec().name, *available);
  }
  for (const auto& [name, begins] : firsts) first = std::min(first, begins);
  if (first == Time::max()) {
    throw std::runtime_error("the drive has not a single readable sample of any sensor");
  }
  for (const auto& [name, begins] : firsts) {
    if (input_limits::within(input_limits::longest_pause, first, begins)) continue;
    throw std::runtime_error(fmt::format(
        "the first sample of '{}' is from {}, more than a day after the first of all, from {}: one "
        "of them has a wrong stamp",
        name, format_time(begins), format_time(first)));
  }
  begin = first;
  if (!resumed) return;
  // A part of the recording will do if it begins before the snapshot.
  if (first < resumed->first || resumed->at < first) {
    throw std::runtime_error(fmt::format(
        "the snapshot is of another recording: it was taken at {}, from {} on, and the first "
        "sample here is from {}",
        format_time(resumed->at), format_time(resumed->first), format_time(first)));
  }
  first = resumed->first;
  begin = resumed->at + Duration(1);  // its tick is done
  for (const auto& driver : drivers) driver->skip_until(resumed->at);
}

// A live run drops samples at full rings instead of blocking their producers.
void Vehicle::Graph::begin_now() {
  first = begin = host_clock->now() + lead;
  for (runtime::EdgeBase* ring : rings.all()) ring->drop_when_full();
}

void Vehicle::Graph::start_drivers() {
  for (const StageSpec& spec : stages::all) {
    if (spec.expected && driver(spec) == nullptr) monitor.watch_missing(spec);
  }
  for (const auto& each : drivers) {
    DriverBase& driver = *each;
    const StageSpec& spec = driver.spec();
    driver.arrivals().start(begin,
                            spec.min_rate > 0.0 ? Watchdog::patience(spec) : Duration::zero());
    const runtime::Thread& thread = start_thread(
        producers, spec, stop.get_token(),
        [&](const std::stop_token& token) { driver.run(clock, token); }, [&] { driver.finish(); });
    monitor.watch_driver(thread, driver);
  }
}

void Vehicle::Graph::start_stages() {
  for (const auto& each : stages) {
    GraphStage& stage = *each;
    for (UseWatch* use : stage.uses()) monitor.watch(*use);
    const runtime::Thread& thread = start_thread(
        producers, stage.spec(), stop.get_token(),
        [&](const std::stop_token& token) { stage.run(clock, begin, token); },
        [&] { stage.finish(); });
    monitor.watch_stage(stage.spec(), thread, stage.meter(), stage.inputs());
  }
}

void Vehicle::Graph::start_snapshots() {
  if (snapshot_requests.empty()) return;
  std::set<Time> moments;
  Duration every{};
  for (const SnapshotRequest& request : snapshot_requests) {
    moments.insert(request.moments.begin(), request.moments.end());
    every = std::max(every, request.every);
  }
  const SnapshotMoments cuts({moments.begin(), moments.end()}, every, begin);
  snapshots = std::make_unique<SnapshotStage>(stages, cuts, [this](const Snapshot& snapshot) {
    for (const SnapshotRequest& request : snapshot_requests) {
      if (request.wants(snapshot.at)) request.handler(snapshot);
    }
  });
  for (const runtime::EdgeBase* ring : snapshots->rings()) monitor.watch(*ring);
  monitor.watch_stage(stages::snapshot,
                      start_thread(
                          producers, stages::snapshot, {},
                          [this](const std::stop_token&) { snapshots->run(first); },
                          [this] { snapshots->finish(); }),
                      snapshots->meter(), {});
}

// These threads end after all producers have ended, so that every result is published.
void Vehicle::Graph::start_listeners() {
  if (preview) {
    monitor.watch_stage(stages::preview,
                        start_thread(
                            listeners, stages::preview, end_preview.get_token(),
                            [this](const std::stop_token& end) { preview->run(end); },
                            [this] { preview->finish(); }),
                        preview->meter(), {});
  }
  monitor.watch_stage(stages::publisher,
                      start_thread(
                          listeners, stages::publisher, {},
                          [this](const std::stop_token&) { publisher.run(begin, clock); },
                          [this] { publisher.finish(); }),
                      publisher.meter(), {});
  monitor.watch_stage(stages::health,
                      start_thread(
                          listeners, stages::health, end_health.get_token(),
                          [this](const std::stop_token& end) { run_health(end); },
                          [this] {
                            for (auto* ring : reports.rings()) ring->finish();
                          }),
                      health_meter, {});
}

void Vehicle::Graph::start() {
  host_clock != nullptr ? begin_now() : find_first();
  for (const runtime::EdgeBase* ring : rings.all()) monitor.watch(*ring);
  for (const MessageSink* sink : publisher.sinks()) monitor.watch(*sink);
  // A live vehicle without cameras has no image to count from.
  if (host_clock == nullptr || rings.has(stages::camera)) monitor.watch_path(fusion->camera_path());
  monitor.watch_path(fusion->imu_path());

  cpu_at_start = process_cpu_seconds();
  started = runtime::monotonic_now();
  if (host_clock != nullptr) {
    clock.start(begin, host_clock->shows(begin));
  } else {
    clock.start(begin, lead);
  }
  monitor.start(begin, started, first);
  start_snapshots();
  start_drivers();
  start_stages();
  start_listeners();
  started_all.count_down();
}

void Vehicle::Graph::wait() {
  for (runtime::Thread& thread : producers) thread.join();
  stop.request_stop();  // this ends the loaders whose driver has failed
  end_preview.request_stop();
  end_health.request_stop();
  health_bell.ring();
  for (runtime::Thread& thread : listeners) thread.join();
  if (wall == Duration::zero()) {
    wall = runtime::monotonic_now() - started;
    cpu = process_cpu_seconds() - cpu_at_start;
    monitor.restart_rates();
    last_report = look(fusion->position() - begin);
    named = monitor.namings(fusion->position());
  }
}

}  // namespace maploop::vehicle
