#include "runtime/vehicle/vehicle.h"

#include <algorithm>
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

}  // namespace

Vehicle::Graph::Graph(const VehicleConfig& vehicle_config, const StereoCalibration& calibration,
                      Sensors sensors, const runtime::DataClock& data_clock,
                      std::vector<MessageSink*> sinks, Observer observer,
                      runtime::Tracer* run_tracer)
    : config(vehicle_config),
      clock(data_clock),
      tracer(run_tracer),
      images(make_edge<StereoPair>(edges::camera_stereo, &stereo_bell)),
      camera("camera", prefetched(stages::camera, std::move(sensors.camera)), {&images}),
      velodyne("velodyne", prefetched(stages::velodyne, std::move(sensors.velodyne)), {}),
      imu("imu", std::move(sensors.imu), {&to_fusion.imu, &to_publisher.imu}),
      gnss("gnss", std::move(sensors.gnss), {&to_fusion.gnss, &to_publisher.gnss}),
      reference("reference", std::move(sensors.reference), {&to_publisher.reference}),
      stereo(stereo::StereoOdometry(calibration, config.stereo), images, stereo_bell,
             to_fusion.odometry, to_publisher.odometry),
      fusion(fusion::ReducedImuFilter(config.fusion), to_fusion, to_publisher.nav_state,
             to_publisher.image_state),
      publisher(to_publisher, std::move(sinks), std::move(observer)),
      wake_all(stop.get_token(), [this] {
        stereo_bell.ring();
        to_fusion.bell.ring();
      }) {
  camera.trace_to(trace_buffer(stages::camera.name));
  velodyne.trace_to(trace_buffer(stages::velodyne.name));
  imu.trace_to(trace_buffer(stages::imu.name));
  gnss.trace_to(trace_buffer(stages::gnss.name));
  reference.trace_to(trace_buffer(stages::reference.name));
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

void Vehicle::Graph::start() {
  for (const std::optional<Time>& available :
       {camera.load_first(), velodyne.load_first(), imu.load_first(), gnss.load_first(),
        reference.load_first()}) {
    if (available) first = std::min(first, *available);
  }
  if (first == Time::max()) {
    throw std::runtime_error("the drive has not a single readable sample of any sensor");
  }
  for (const runtime::EdgeBase* edge : std::initializer_list<const runtime::EdgeBase*>{
           &images, &to_fusion.imu, &to_fusion.gnss, &to_fusion.odometry, &to_publisher.imu,
           &to_publisher.gnss, &to_publisher.reference, &to_publisher.odometry,
           &to_publisher.nav_state, &to_publisher.image_state, &to_publisher.reports}) {
    monitor.watch(*edge);
  }
  for (const MessageSink* sink : publisher.sinks()) monitor.watch(*sink);
  monitor.watch_path(fusion.camera_path());
  monitor.watch_path(fusion.imu_path());

  cpu_at_start = process_cpu_seconds();
  started = runtime::monotonic_now();
  clock.start(first, lead);
  monitor.start(first, started);
  const SchedulingParameters& scheduling = config.scheduling;
  start_driver(stages::camera, scheduling.camera, camera);
  start_driver(stages::velodyne, scheduling.velodyne, velodyne);
  start_driver(stages::imu, scheduling.imu, imu);
  start_driver(stages::gnss, scheduling.gnss, gnss);
  start_driver(stages::reference, scheduling.reference, reference);
  monitor.watch_stage(stages::stereo,
                      start_thread(
                          producers, stages::stereo, scheduling.stereo, stop.get_token(),
                          [this](const std::stop_token& token) { stereo.run(clock, token); },
                          [this] { stereo.finish(); }),
                      stereo.meter(), {&images});
  monitor.watch_stage(stages::fusion,
                      start_thread(
                          producers, stages::fusion, scheduling.fusion, stop.get_token(),
                          [this](const std::stop_token& token) { fusion.run(clock, first, token); },
                          [this] { fusion.finish(); }),
                      fusion.meter(), {&to_fusion.imu, &to_fusion.gnss, &to_fusion.odometry});
  // These two end after everybody else has, so that nothing produced is left unsaid.
  monitor.watch_stage(stages::publisher,
                      start_thread(
                          listeners, stages::publisher, scheduling.publisher, {},
                          [this](const std::stop_token&) { publisher.run(); }, [] {}),
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
  Time looked = first;
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
    runtime::run_periodic(clock, first, schedule, end, [&](const runtime::Tick& tick) {
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
    last_report = look(fusion.position() - first);
  }
}

Vehicle::Vehicle(const VehicleConfig& config, const StereoCalibration& calibration, Sensors sensors,
                 const runtime::DataClock& clock, std::vector<MessageSink*> sinks,
                 Observer observer, runtime::Tracer* tracer)
    : graph_(std::make_unique<Graph>(config, calibration, std::move(sensors), clock,
                                     std::move(sinks), std::move(observer), tracer)) {}

Vehicle::~Vehicle() = default;

void Vehicle::slow_down(StageDelays delays) {
  graph_->stereo.slow_down(std::move(delays.stereo));
  graph_->fusion.slow_down(std::move(delays.fusion));
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
  return next_of(graph_->images);
}

Time Vehicle::next_sample() const {
  return std::min({next_of(graph_->images), next_of(graph_->to_fusion.imu),
                   next_of(graph_->to_fusion.gnss), next_of(graph_->to_publisher.reference)});
}

std::uint64_t Vehicle::deadline_misses() const {
  return graph_->stereo.meter().latency().miss_count() +
         graph_->fusion.meter().latency().miss_count();
}

runtime::DataClock& Vehicle::clock() {
  return graph_->clock;
}

}  // namespace maploop::vehicle
