#include "runtime/vehicle/vehicle.h"

#include <sys/resource.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <latch>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/core/thread.h"
#include "runtime/vehicle/fusion_stage.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/health_monitor.h"
#include "runtime/vehicle/prefetched_source.h"
#include "runtime/vehicle/replay_driver.h"
#include "runtime/vehicle/stereo_stage.h"

namespace maploop::vehicle {
namespace {

// Between start() and the first release, so that every thread is up.
constexpr Duration lead = milliseconds(100);
// Samples decoded ahead: longer than a hiccup of the disk.
constexpr std::size_t decoded_ahead = 6;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// What the estimators did not use, by their own reasons.
std::vector<RefusalCount> refusals(const StereoStage& stereo, const fusion::FilterStatus& filter) {
  std::vector<RefusalCount> all;
  const auto add = [&](const Stage& stage, std::string_view reason, std::uint64_t count) {
    if (count > 0) all.push_back({std::string(stage.name), std::string(reason), count});
  };
  for (std::size_t i = 1; i < odometry_status_count; ++i) {
    const auto status = static_cast<OdometryStatus>(i);
    add(stages::stereo, to_string(status), stereo.count(status));
  }
  for (std::size_t i = 1; i < fusion::reason_count; ++i) {
    const auto reason = static_cast<fusion::Reason>(i);
    add(stages::fusion, to_string(reason), filter.refused_for(reason));
  }
  add(stages::fusion, "held, and too old before the start", filter.unused);
  add(stages::fusion, "restart: the clock jumped", filter.restarts);
  return all;
}

}  // namespace

struct Vehicle::Graph {
  Graph(const VehicleConfig& config, const StereoCalibration& calibration, Sensors sensors,
        const runtime::DataClock& data_clock, std::vector<MessageSink*> sinks, Observer observer);
  ~Graph();

  void start();
  void run_health(const std::stop_token& end);
  RuntimeReport look(Duration elapsed);
  void wait();
  VehicleReport report() const;

  template <class T>
  std::unique_ptr<sensors::Source<T>> prefetched(const Stage& stage,
                                                 std::unique_ptr<sensors::Source<T>> source);
  template <class T>
  void start_driver(const Stage& stage, ReplayDriver<T>& driver);
  runtime::Thread& start_thread(const Stage& stage, int fifo_priority, runtime::Thread::Body body,
                                std::function<void()> at_end);

  VehicleConfig config;
  std::stop_source stop;
  runtime::DataClock clock;
  Time first = Time::max();

  // Edges, by the thread that they end at.
  runtime::Doorbell stereo_bell;
  runtime::Edge<StereoPair> images;
  FusionEdges to_fusion;
  PublisherEdges to_publisher;

  ReplayDriver<StereoPair> camera;
  ReplayDriver<LidarScan> velodyne;
  ReplayDriver<ImuSample> imu;
  ReplayDriver<GnssFix> gnss;
  ReplayDriver<ReferencePose> reference;
  StereoStage stereo;
  FusionStage fusion;
  Publisher publisher;
  HealthMonitor monitor;
  ThreadMeter health_meter{stages::health};
  std::latch all_watched{1};  // the health thread looks at itself, too

  std::stop_callback<std::function<void()>> wake_all;
  std::deque<runtime::Thread> producers;
  std::stop_source end_health;
  runtime::Doorbell health_bell;
  std::unique_ptr<runtime::Thread> health_thread;
  std::unique_ptr<runtime::Thread> publisher_thread;
  MonotonicTime started{};
  Duration wall{};
  double cpu_at_start = 0.0;
  double cpu = 0.0;
  RuntimeReport last_report;  // of the whole run
};

Vehicle::Graph::Graph(const VehicleConfig& vehicle_config, const StereoCalibration& calibration,
                      Sensors sensors, const runtime::DataClock& data_clock,
                      std::vector<MessageSink*> sinks, Observer observer)
    : config(vehicle_config),
      clock(data_clock),
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
      }) {}

Vehicle::Graph::~Graph() {
  stop.request_stop();
  wait();
}

template <class T>
std::unique_ptr<sensors::Source<T>> Vehicle::Graph::prefetched(
    const Stage& stage, std::unique_ptr<sensors::Source<T>> source) {
  if (source == nullptr) return nullptr;
  return std::make_unique<PrefetchedSource<T>>(std::string(stage.name) + " loader",
                                               std::move(source), decoded_ahead, stop.get_token());
}

runtime::Thread& Vehicle::Graph::start_thread(const Stage& stage, int fifo_priority,
                                              runtime::Thread::Body body,
                                              std::function<void()> at_end) {
  const runtime::Scheduling scheduling = clock.is_paced() && fifo_priority != 0
                                             ? runtime::Scheduling::fifo(fifo_priority)
                                             : runtime::Scheduling{};
  return producers.emplace_back(std::string(stage.name), scheduling, stop.get_token(),
                                std::move(body), std::move(at_end));
}

template <class T>
void Vehicle::Graph::start_driver(const Stage& stage, ReplayDriver<T>& driver) {
  const runtime::Thread& thread = start_thread(
      stage, config.scheduling.sensor_priority,
      [&](const std::stop_token& token) { driver.run(clock, token); }, [&] { driver.finish(); });
  monitor.watch(thread, driver.lateness());
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
  monitor.watch_path(fusion.camera_path());
  monitor.watch_path(fusion.imu_path());

  cpu_at_start = cpu_seconds();
  started = runtime::monotonic_now();
  clock.start(first, lead);
  start_driver(stages::camera, camera);
  start_driver(stages::velodyne, velodyne);
  start_driver(stages::imu, imu);
  start_driver(stages::gnss, gnss);
  start_driver(stages::reference, reference);
  monitor.watch(start_thread(
                    stages::stereo, config.scheduling.stereo_priority,
                    [this](const std::stop_token& token) { stereo.run(clock, token); },
                    [this] { stereo.finish(); }),
                stereo.meter());
  monitor.watch(start_thread(
                    stages::fusion, config.scheduling.fusion_priority,
                    [this](const std::stop_token& token) { fusion.run(clock, first, token); },
                    [this] { fusion.finish(); }),
                fusion.meter());
  // These two end after everybody else has, so that nothing produced is left unsaid.
  publisher_thread = std::make_unique<runtime::Thread>(
      std::string(stages::publisher.name), runtime::Scheduling{}, std::stop_token{},
      [this](const std::stop_token&) { publisher.run(); }, [] {});
  monitor.watch(*publisher_thread, publisher.meter());
  health_thread = std::make_unique<runtime::Thread>(
      std::string(stages::health.name), runtime::Scheduling{}, end_health.get_token(),
      [this](const std::stop_token& end) { run_health(end); },
      [this] { to_publisher.reports.finish(); });
  monitor.watch(*health_thread, health_meter);
  all_watched.count_down();
}

RuntimeReport Vehicle::Graph::look(Duration elapsed) {
  const Time stamp = fusion.position();
  RuntimeReport report;
  report.stamp = report.available = stamp;
  report.health = monitor.health(stamp, elapsed, clock);
  report.health.elapsed = to_seconds(runtime::monotonic_now() - started);
  report.health.cpu = cpu_seconds() - cpu_at_start;
  report.deadlines = monitor.deadlines(stamp);
  return report;
}

void Vehicle::Graph::run_health(const std::stop_token& end) {
  Time looked = first;
  const auto say = [&] {
    const MonotonicTime began = runtime::monotonic_now();
    const Time now = fusion.position();
    to_publisher.reports.push(look(now - looked), end);
    looked = now;
    health_meter.ran(runtime::monotonic_now() - began);
  };
  all_watched.wait();
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
  if (health_thread) health_thread->join();
  if (publisher_thread) publisher_thread->join();
  if (wall == Duration::zero()) {
    wall = runtime::monotonic_now() - started;
    cpu = cpu_seconds() - cpu_at_start;
    monitor.restart_rates();
    last_report = look(fusion.position() - first);
  }
}

VehicleReport Vehicle::Graph::report() const {
  VehicleReport r;
  runtime::Histogram lateness;
  const auto add = [&](const auto& driver) {
    r.sensors.push_back({driver.lateness().name(), driver.report(), driver.lateness().summary()});
    lateness.merge(driver.lateness().histogram());
  };
  add(camera);
  add(velodyne);
  add(imu);
  add(gnss);
  add(reference);
  r.lateness = lateness.summarize("all sensors");
  r.health = last_report.health;
  r.deadlines = last_report.deadlines;
  r.refusals = refusals(stereo, fusion.filter().status());
  r.stalls = clock.stalls();
  r.stalled = clock.stalled();
  r.data_seconds = to_seconds(fusion.position() - first);
  r.wall_seconds = to_seconds(wall);
  r.cpu_seconds = cpu;
  r.peak_memory = peak_memory();
  return r;
}

Vehicle::Vehicle(const VehicleConfig& config, const StereoCalibration& calibration, Sensors sensors,
                 const runtime::DataClock& clock, std::vector<MessageSink*> sinks,
                 Observer observer)
    : graph_(std::make_unique<Graph>(config, calibration, std::move(sensors), clock,
                                     std::move(sinks), std::move(observer))) {}

Vehicle::~Vehicle() = default;

void Vehicle::slow_down(StageDelays delays) {
  graph_->stereo.slow_down(std::move(delays.stereo));
  graph_->fusion.slow_down(std::move(delays.fusion));
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
