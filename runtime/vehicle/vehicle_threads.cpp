// The vehicle's threads: their start and their end.
#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "msgs/input_limits.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/vehicle_graph.h"

namespace maploop::vehicle {
namespace {

// Between start() and the first release, so that every thread is up.
constexpr Duration lead = milliseconds(100);

}  // namespace

runtime::Thread& Vehicle::Graph::start_thread(std::deque<runtime::Thread>& threads,
                                              const Stage& stage,
                                              const runtime::Scheduling& scheduling,
                                              std::stop_token token, runtime::Thread::Body body,
                                              std::function<void()> at_end) {
  runtime::Thread& thread = threads.emplace_back(
      std::string(stage.name), clock.is_paced() ? scheduling : runtime::Scheduling{},
      std::move(token), std::move(body), std::move(at_end));
  runtime::append(readiness, thread.settings());
  return thread;
}

template <class T>
void Vehicle::Graph::start_driver(const Stage& stage, const runtime::Scheduling& scheduling,
                                  Driver<T>& driver) {
  driver.arrivals().start(begin,
                          stage.min_rate > 0.0 ? Watchdog::patience(stage) : Duration::zero());
  const runtime::Thread& thread = start_thread(
      producers, stage, scheduling, stop.get_token(),
      [&](const std::stop_token& token) { driver.run(clock, token); }, [&] { driver.finish(); });
  monitor.watch_driver(stage, thread, driver.lateness(), driver.arrivals(), driver.absent());
}

void Vehicle::Graph::find_first() {
  std::vector<std::pair<std::string, Time>> firsts;
  drivers.each([&](auto& driver) {
    if (const auto available = driver.load_first())
      firsts.emplace_back(driver.lateness().name(), *available);
  });
  for (const auto& [name, begins] : firsts) first = std::min(first, begins);
  if (first == Time::max()) {
    throw std::runtime_error("the drive has not a single readable sample of any sensor");
  }
  for (const auto& [name, begins] : firsts) {
    if (input_limits::within(input_limits::longest_pause, first, begins)) continue;
    throw std::runtime_error("the first sample of '" + name + "' is from " + format_time(begins) +
                             ", more than a day after the first of all, from " +
                             format_time(first) + ": one of them has a wrong stamp");
  }
  begin = first;
  if (!resumed) return;
  if (resumed->first != first) {
    throw std::runtime_error("the snapshot is of another recording: its first sample is from " +
                             format_time(resumed->first) + ", and here it is from " +
                             format_time(first));
  }
  if (resumed->at < first) {
    throw std::runtime_error("the snapshot is damaged: it says that it was taken at " +
                             format_time(resumed->at) + ", before the recording begins");
  }
  begin = resumed->at + Duration(1);  // its tick is done
  drivers.each([this](auto& driver) { driver.skip_until(resumed->at); });
}

// Nobody waits for a full ring either.
void Vehicle::Graph::begin_now() {
  first = begin = host_clock->now() + lead;
  for (runtime::EdgeBase* edge : all_edges()) edge->drop_when_full();
}

void Vehicle::Graph::start_snapshots() {
  if (wishes.empty()) return;
  std::set<Time> moments;
  for (const SnapshotWish& wish : wishes) moments.insert(wish.moments.begin(), wish.moments.end());
  const std::vector<Time> cuts(moments.upper_bound(begin), moments.end());
  PartSizes bytes{stereo.saved_bytes(), std::nullopt, std::nullopt, fusion.saved_bytes(),
                  std::nullopt};
  if (lidar) bytes.lidar = lidar->saved_bytes();
  if (ppp) bytes.ppp = PppStage::saved_bytes();
  if (mapmatch) bytes.mapmatch = mapmatch->saved_bytes();
  snapshots = std::make_unique<SnapshotStage>(bytes, [this](const Snapshot& snapshot) {
    for (const SnapshotWish& wish : wishes) {
      if (wish.moments.contains(snapshot.at)) wish.handler(snapshot);
    }
  });
  SnapshotEdges& parts = snapshots->edges();
  stereo.save_at(cuts, parts.stereo);
  fusion.save_at(cuts, parts.fusion);
  monitor.watch(parts.stereo);
  monitor.watch(parts.fusion);
  if (lidar) {
    lidar->save_at(cuts, *parts.lidar);
    monitor.watch(*parts.lidar);
  }
  if (ppp) {
    ppp->save_at(cuts, *parts.ppp);
    monitor.watch(*parts.ppp);
  }
  if (mapmatch) {
    mapmatch->save_at(cuts, *parts.mapmatch);
    monitor.watch(*parts.mapmatch);
  }
  monitor.watch_stage(stages::snapshot,
                      start_thread(
                          producers, stages::snapshot, config.scheduling.snapshot, {},
                          [this](const std::stop_token&) { snapshots->run(first); },
                          [this] { snapshots->finish(); }),
                      snapshots->meter(), {});
}

// From the images, or as it was recorded.
void Vehicle::Graph::start_odometry() {
  if (odometry_recorded) {
    start_driver(stages::odometry, config.scheduling.odometry, *drivers.odometry);
    start_driver(stages::visual_log, config.scheduling.odometry, *drivers.visual_log);
    start_driver(stages::lidar_log, config.scheduling.odometry, *drivers.lidar_log);
    start_thread(
        producers, stages::stereo, config.scheduling.stereo, stop.get_token(),
        [this](const std::stop_token& token) { stereo.idle(token); }, [] {});
  } else {
    start_stereo();
  }
  if (lidar) {
    monitor.watch(lidar->use());
    monitor.watch_stage(stages::lidar,
                        start_thread(
                            producers, stages::lidar, config.scheduling.lidar, stop.get_token(),
                            [this](const std::stop_token& token) { lidar->run(clock, token); },
                            [this] { lidar->finish(); }),
                        lidar->meter(), {&to_lidar->scans, &to_lidar->visual});
  } else if (!odometry_recorded) {
    to_publisher.lidar.finish();
  }
}

void Vehicle::Graph::start_stereo() {
  const runtime::Thread& thread = start_thread(
      producers, stages::stereo, config.scheduling.stereo, stop.get_token(),
      [this](const std::stop_token& token) { stereo.run(clock, token); },
      [this] { stereo.finish(); });
  // Of a drive with GNSS alone, or a vehicle without cameras, nobody waits for images.
  if ((to_ppp || host_clock != nullptr) && drivers.camera->absent()) return;
  monitor.watch(stereo.use());
  monitor.watch_stage(stages::stereo, thread, stereo.meter(), {&images});
}

// The receiver's fixes, or its observations and what makes fixes from them.
void Vehicle::Graph::start_gnss() {
  if (!ppp) {
    start_driver(stages::gnss, config.scheduling.gnss, *drivers.gnss);
    return;
  }
  start_driver(stages::gnss, config.scheduling.gnss, *drivers.epochs);
  if (to_ppp->corrections)
    start_driver(stages::corrections, config.scheduling.gnss, *drivers.corrections);
  monitor.watch(ppp->use());
  monitor.watch_stage(stages::ppp,
                      start_thread(
                          producers, stages::ppp, config.scheduling.ppp, stop.get_token(),
                          [this](const std::stop_token& token) { ppp->run(clock, token); },
                          [this] { ppp->finish(); }),
                      ppp->meter(), {&to_ppp->epochs});
}

void Vehicle::Graph::start_mapmatch() {
  if (!mapmatch) {
    to_publisher.map_match.finish();
    to_publisher.map_feedback.finish();
    return;
  }
  if (!to_fusion.feedback) to_publisher.map_feedback.finish();
  monitor.watch_stage(
      stages::mapmatch,
      start_thread(
          producers, stages::mapmatch, config.scheduling.mapmatch, stop.get_token(),
          [this](const std::stop_token& token) { mapmatch->run(clock, begin, token); },
          [this] { mapmatch->finish(); }),
      mapmatch->meter(), {&to_mapmatch->nav_state, &to_mapmatch->visual});
}

// It ends when those who answer it have.
void Vehicle::Graph::start_preview() {
  if (!preview) return;
  monitor.watch_stage(
      stages::preview,
      start_thread(
          listeners, stages::preview, config.scheduling.preview, end_preview.get_token(),
          [this](const std::stop_token& end) { preview->run(end); }, [this] { preview->finish(); }),
      preview->meter(), {});
}

void Vehicle::Graph::start() {
  host_clock != nullptr ? begin_now() : find_first();
  for (const runtime::EdgeBase* edge : all_edges()) monitor.watch(*edge);
  if (!raw) {
    to_publisher.camera.finish();
    to_publisher.velodyne.finish();
  }
  for (const MessageSink* sink : publisher.sinks()) monitor.watch(*sink);
  // Scans alone have no image to count from.
  if (host_clock == nullptr || !drivers.camera->absent()) monitor.watch_path(fusion.camera_path());
  monitor.watch_path(fusion.imu_path());

  cpu_at_start = process_cpu_seconds();
  started = runtime::monotonic_now();
  if (host_clock != nullptr) {
    clock.start(begin, host_clock->shows(begin));
  } else {
    clock.start(begin, lead);
  }
  monitor.start(begin, started, first);
  start_snapshots();
  const SchedulingParameters& scheduling = config.scheduling;
  start_driver(stages::camera, scheduling.camera, *drivers.camera);
  start_driver(stages::velodyne, scheduling.velodyne, *drivers.velodyne);
  start_driver(stages::imu, scheduling.imu, *drivers.imu);
  start_gnss();
  start_driver(stages::wheel, scheduling.wheel, *drivers.wheel);
  start_driver(stages::reference, scheduling.reference, *drivers.reference);
  start_odometry();
  for (UseWatch* use : fusion.uses()) monitor.watch(*use);
  monitor.watch_stage(stages::fusion,
                      start_thread(
                          producers, stages::fusion, scheduling.fusion, stop.get_token(),
                          [this](const std::stop_token& token) { fusion.run(clock, begin, token); },
                          [this] { fusion.finish(); }),
                      fusion.meter(),
                      {&to_fusion.imu, &to_fusion.gnss, &to_fusion.wheel, &to_fusion.odometry});
  start_mapmatch();
  start_preview();
  // These two end after everybody else has, so that nothing produced is left unsaid.
  monitor.watch_stage(stages::publisher,
                      start_thread(
                          listeners, stages::publisher, scheduling.publisher, {},
                          [this](const std::stop_token&) { publisher.run(begin, clock); },
                          [this] { publisher.finish(); }),
                      publisher.meter(), {});
  monitor.watch_stage(stages::health,
                      start_thread(
                          listeners, stages::health, scheduling.health, end_health.get_token(),
                          [this](const std::stop_token& end) { run_health(end); },
                          [this] { to_publisher.reports.finish(); }),
                      health_meter, {});
  started_all.count_down();
}

void Vehicle::Graph::wait() {
  for (runtime::Thread& thread : producers) thread.join();
  end_preview.request_stop();
  end_health.request_stop();
  health_bell.ring();
  for (runtime::Thread& thread : listeners) thread.join();
  if (wall == Duration::zero()) {
    wall = runtime::monotonic_now() - started;
    cpu = process_cpu_seconds() - cpu_at_start;
    monitor.restart_rates();
    last_imu_delay = fusion.filter_status().imu_delay;
    last_report = look(fusion.position() - begin);
  }
}

}  // namespace maploop::vehicle
