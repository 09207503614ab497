#include "runtime/vehicle/vehicle.h"

#include <algorithm>
#include <initializer_list>
#include <set>
#include <stdexcept>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/prefetched_source.h"
#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/refusals.h"
#include "runtime/vehicle/vehicle_graph.h"

namespace maploop::vehicle {
namespace {

// Between start() and the first release, so that every thread is up.
constexpr Duration lead = milliseconds(100);
// Samples decoded ahead: longer than a hiccup of the disk.
constexpr std::size_t decoded_ahead = 6;

template <class T>
using Edges = std::vector<runtime::Edge<T>*>;

bool wants_raw(const std::vector<MessageSink*>& sinks) {
  return std::any_of(sinks.begin(), sinks.end(),
                     [](const MessageSink* sink) { return sink->wants_raw(); });
}

}  // namespace

Vehicle::Graph::Graph(const VehicleConfig& vehicle_config, const VehicleCalibration& calibration,
                      Sensors sensors, const runtime::DataClock& data_clock,
                      std::vector<MessageSink*> sinks, Observer observer,
                      runtime::Tracer* run_tracer)
    : config(vehicle_config),
      clock(data_clock),
      tracer(run_tracer),
      images(make_edge<StereoPair>(edges::camera_stereo, &stereo_bell)),
      raw(wants_raw(sinks)),
      odometry_recorded(sensors.odometry != nullptr),
      camera("camera", prefetched(stages::camera, std::move(sensors.camera)),
             raw ? Edges<StereoPair>{&to_publisher.camera, &images} : Edges<StereoPair>{&images}),
      velodyne("velodyne", prefetched(stages::velodyne, std::move(sensors.velodyne)),
               raw ? Edges<LidarScan>{&to_publisher.velodyne} : Edges<LidarScan>{}),
      imu("imu", std::move(sensors.imu), {&to_fusion.imu, &to_publisher.imu}),
      gnss("gnss", std::move(sensors.gnss), {&to_fusion.gnss, &to_publisher.gnss}),
      reference("reference", std::move(sensors.reference), {&to_publisher.reference}),
      odometry("odometry", std::move(sensors.odometry),
               {&to_fusion.odometry, &to_publisher.odometry}),
      stereo(stereo::StereoOdometry(calibration.stereo, config.stereo), images, stereo_bell,
             to_fusion.odometry, to_publisher.odometry),
      fusion(fusion::ReducedImuFilter(config.fusion), to_fusion, to_publisher.nav_state,
             to_publisher.image_state),
      publisher(calibration, to_publisher, std::move(sinks), std::move(observer)),
      wake_all(stop.get_token(), [this] {
        stereo_bell.ring();
        to_fusion.bell.ring();
      }) {
  camera.trace_to(trace_buffer(stages::camera.name));
  velodyne.trace_to(trace_buffer(stages::velodyne.name));
  imu.trace_to(trace_buffer(stages::imu.name));
  gnss.trace_to(trace_buffer(stages::gnss.name));
  reference.trace_to(trace_buffer(stages::reference.name));
  if (odometry_recorded) odometry.trace_to(trace_buffer(stages::odometry.name));
  stereo.trace_to(trace_buffer(stages::stereo.name));
  fusion.trace_to(trace_buffer(stages::fusion.name));
  publisher.trace_to(trace_buffer(stages::publisher.name));
  health_trace = trace_buffer(stages::health.name);
}

Vehicle::Graph::~Graph() {
  stop.request_stop();
  wait();
}

runtime::TraceBuffer* Vehicle::Graph::trace_buffer(std::string_view thread) {
  return tracer != nullptr ? &tracer->thread(std::string(thread)) : nullptr;
}

template <class T>
std::unique_ptr<sensors::Source<T>> Vehicle::Graph::prefetched(
    const Stage& stage, std::unique_ptr<sensors::Source<T>> source) {
  if (source == nullptr) return nullptr;
  const std::string name = std::string(stage.name) + " loader";
  return std::make_unique<PrefetchedSource<T>>(name, std::move(source), decoded_ahead,
                                               stop.get_token(), trace_buffer(name));
}

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
                                  ReplayDriver<T>& driver) {
  const runtime::Thread& thread = start_thread(
      producers, stage, scheduling, stop.get_token(),
      [&](const std::stop_token& token) { driver.run(clock, token); }, [&] { driver.finish(); });
  monitor.watch_driver(stage, thread, driver.lateness(), driver.absent());
}

void Vehicle::Graph::find_first() {
  for (const std::optional<Time>& available :
       {camera.load_first(), velodyne.load_first(), imu.load_first(), gnss.load_first(),
        reference.load_first(), odometry.load_first()}) {
    if (available) first = std::min(first, *available);
  }
  if (first == Time::max()) {
    throw std::runtime_error("the drive has not a single readable sample of any sensor");
  }
  begin = first;
  if (!resumed) return;
  if (resumed->first != first) {
    throw std::runtime_error("the snapshot is of another recording: its first sample is from " +
                             format_time(resumed->first) + ", and here it is from " +
                             format_time(first));
  }
  begin = resumed->at + Duration(1);  // its tick is done
  camera.skip_until(resumed->at);
  velodyne.skip_until(resumed->at);
  imu.skip_until(resumed->at);
  gnss.skip_until(resumed->at);
  reference.skip_until(resumed->at);
  odometry.skip_until(resumed->at);
}

void Vehicle::Graph::start_snapshots() {
  if (wishes.empty()) return;
  std::set<Time> moments;
  for (const SnapshotWish& wish : wishes) moments.insert(wish.moments.begin(), wish.moments.end());
  const std::vector<Time> cuts(moments.upper_bound(begin), moments.end());
  snapshots = std::make_unique<SnapshotStage>(stereo.saved_bytes(), fusion.saved_bytes(),
                                              [this](const Snapshot& snapshot) {
                                                for (const SnapshotWish& wish : wishes) {
                                                  if (wish.moments.contains(snapshot.at))
                                                    wish.handler(snapshot);
                                                }
                                              });
  stereo.save_at(cuts, snapshots->edges().stereo);
  fusion.save_at(cuts, snapshots->edges().fusion);
  monitor.watch(snapshots->edges().stereo);
  monitor.watch(snapshots->edges().fusion);
  monitor.watch_stage(stages::snapshot,
                      start_thread(
                          producers, stages::snapshot, config.scheduling.snapshot, {},
                          [this](const std::stop_token&) { snapshots->run(first); }, [] {}),
                      snapshots->meter(), {});
}

// From the images, or as it was recorded.
void Vehicle::Graph::start_odometry() {
  if (odometry_recorded) {
    start_driver(stages::odometry, config.scheduling.odometry, odometry);
    start_thread(
        producers, stages::stereo, config.scheduling.stereo, stop.get_token(),
        [this](const std::stop_token& token) { stereo.idle(token); }, [] {});
  } else {
    monitor.watch_stage(stages::stereo,
                        start_thread(
                            producers, stages::stereo, config.scheduling.stereo, stop.get_token(),
                            [this](const std::stop_token& token) { stereo.run(clock, token); },
                            [this] { stereo.finish(); }),
                        stereo.meter(), {&images});
  }
}

void Vehicle::Graph::start() {
  find_first();
  for (const runtime::EdgeBase* edge : std::initializer_list<const runtime::EdgeBase*>{
           &images, &to_fusion.imu, &to_fusion.gnss, &to_fusion.odometry, &to_publisher.imu,
           &to_publisher.gnss, &to_publisher.reference, &to_publisher.odometry,
           &to_publisher.nav_state, &to_publisher.image_state, &to_publisher.reports}) {
    monitor.watch(*edge);
  }
  if (raw) {
    monitor.watch(to_publisher.camera);
    monitor.watch(to_publisher.velodyne);
  } else {
    to_publisher.camera.finish();
    to_publisher.velodyne.finish();
  }
  for (const MessageSink* sink : publisher.sinks()) monitor.watch(*sink);
  monitor.watch_path(fusion.camera_path());
  monitor.watch_path(fusion.imu_path());

  cpu_at_start = process_cpu_seconds();
  started = runtime::monotonic_now();
  clock.start(begin, lead);
  monitor.start(begin, started);
  start_snapshots();
  const SchedulingParameters& scheduling = config.scheduling;
  start_driver(stages::camera, scheduling.camera, camera);
  start_driver(stages::velodyne, scheduling.velodyne, velodyne);
  start_driver(stages::imu, scheduling.imu, imu);
  start_driver(stages::gnss, scheduling.gnss, gnss);
  start_driver(stages::reference, scheduling.reference, reference);
  start_odometry();
  monitor.watch_stage(stages::fusion,
                      start_thread(
                          producers, stages::fusion, scheduling.fusion, stop.get_token(),
                          [this](const std::stop_token& token) { fusion.run(clock, begin, token); },
                          [this] { fusion.finish(); }),
                      fusion.meter(), {&to_fusion.imu, &to_fusion.gnss, &to_fusion.odometry});
  // These two end after everybody else has, so that nothing produced is left unsaid.
  monitor.watch_stage(stages::publisher,
                      start_thread(
                          listeners, stages::publisher, scheduling.publisher, {},
                          [this](const std::stop_token&) { publisher.run(begin); }, [] {}),
                      publisher.meter(), {});
  monitor.watch_stage(stages::health,
                      start_thread(
                          listeners, stages::health, scheduling.health, end_health.get_token(),
                          [this](const std::stop_token& end) { run_health(end); },
                          [this] { to_publisher.reports.finish(); }),
                      health_meter, {});
  started_all.count_down();
}

RuntimeReport Vehicle::Graph::look(Duration elapsed) {
  const Time stamp = fusion.position();
  RuntimeReport report;
  report.stamp = report.available = stamp;
  report.health = monitor.health(stamp, elapsed, clock, readiness);
  report.health.elapsed = to_seconds(runtime::monotonic_now() - started);
  report.health.cpu = process_cpu_seconds() - cpu_at_start;
  report.health.refusals = refusals(stereo, fusion.filter_status());
  report.deadlines = monitor.deadlines(stamp);
  return report;
}

void Vehicle::Graph::run_health(const std::stop_token& end) {
  started_all.wait();
  Time looked = begin;
  const auto say = [&] {
    const runtime::TraceSpan span(health_trace, "health");
    const MonotonicTime began = runtime::monotonic_now();
    const Time now = fusion.position();
    to_publisher.reports.push(look(now - looked), end);
    looked = now;
    health_meter.ran(runtime::monotonic_now() - began);
  };
  // In virtual time there are no rates to watch: one report at the end.
  if (clock.is_paced()) {
    const runtime::Schedule schedule{stages::health.period, stages::health.phase,
                                     stages::health.overrun};
    runtime::run_periodic(clock, begin, schedule, end, [&](const runtime::Tick& tick) {
      if (clock.keeps_time(tick.time)) {
        health_meter.woke(tick, clock, clock.due(tick.time), runtime::monotonic_now());
      }
      say();
      return true;
    });
  }
  for (;;) {
    const std::uint32_t heard = health_bell.listen();
    if (end.stop_requested()) break;
    health_bell.wait(heard);
  }
  say();
}

void Vehicle::Graph::wait() {
  for (runtime::Thread& thread : producers) thread.join();
  end_health.request_stop();
  health_bell.ring();
  for (runtime::Thread& thread : listeners) thread.join();
  if (wall == Duration::zero()) {
    wall = runtime::monotonic_now() - started;
    cpu = process_cpu_seconds() - cpu_at_start;
    monitor.restart_rates();
    last_report = look(fusion.position() - begin);
  }
}

Vehicle::Vehicle(const VehicleConfig& config, const VehicleCalibration& calibration,
                 Sensors sensors, const runtime::DataClock& clock, std::vector<MessageSink*> sinks,
                 Observer observer, runtime::Tracer* tracer)
    : graph_(std::make_unique<Graph>(config, calibration, std::move(sensors), clock,
                                     std::move(sinks), std::move(observer), tracer)) {}

Vehicle::~Vehicle() = default;

void Vehicle::slow_down(StageDelays delays) {
  graph_->stereo.slow_down(std::move(delays.stereo));
  graph_->fusion.slow_down(std::move(delays.fusion));
}

void Vehicle::take_snapshots(std::vector<Time> moments, SnapshotHandler handler) {
  for (Time& t : moments) t = runtime::first_tick(t, stages::fusion.period);
  graph_->wishes.push_back({{moments.begin(), moments.end()}, std::move(handler)});
}

void Vehicle::resume(const Snapshot& snapshot) {
  graph_->stereo.resume(snapshot.stereo);
  graph_->fusion.resume(snapshot.fusion);
  graph_->resumed = Snapshot{snapshot.at, snapshot.first, {}, {}};
}

void Vehicle::prepared(const runtime::RealtimeReport& report) {
  runtime::append(graph_->readiness, report.settings);
}

const runtime::RealtimeReport& Vehicle::readiness() const {
  return graph_->readiness;
}

void Vehicle::start() {
  graph_->start();
}
void Vehicle::stop() {
  graph_->stop.request_stop();
}

bool Vehicle::running() const {
  return std::any_of(graph_->producers.begin(), graph_->producers.end(),
                     [](const runtime::Thread& thread) { return !thread.ended(); });
}

void Vehicle::wait() {
  graph_->wait();
}
VehicleReport Vehicle::report() const {
  return graph_->report();
}
Time Vehicle::position() const {
  return graph_->fusion.position();
}
Time Vehicle::first() const {
  return graph_->first;
}

namespace {

// A driver promises up to just before its next sample.
Time next_of(const runtime::EdgeBase& edge) {
  const Time promised = edge.promised();
  return promised == Time::max() ? promised : promised + Duration(1);
}

}  // namespace

Time Vehicle::next_image() const {
  return next_of(graph_->odometry_recorded
                     ? static_cast<const runtime::EdgeBase&>(graph_->to_fusion.odometry)
                     : graph_->images);
}

Time Vehicle::next_sample() const {
  return std::min({next_image(), next_of(graph_->to_fusion.imu), next_of(graph_->to_fusion.gnss),
                   next_of(graph_->to_publisher.reference)});
}

std::uint64_t Vehicle::deadline_misses() const {
  return graph_->stereo.meter().latency().miss_count() +
         graph_->fusion.meter().latency().miss_count();
}

runtime::DataClock& Vehicle::clock() {
  return graph_->clock;
}

}  // namespace maploop::vehicle
