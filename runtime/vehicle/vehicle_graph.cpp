#include "runtime/vehicle/vehicle_graph.h"

#include <algorithm>
#include <initializer_list>
#include <set>
#include <stdexcept>
#include <utility>

#include "mapmatch/reasons.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/prefetched_source.h"
#include "runtime/vehicle/process_usage.h"

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

// A vehicle without cameras has a stereo thread that never sees an image; its estimator wants some
// camera all the same.
StereoCalibration camera_of(const VehicleCalibration& calibration) {
  if (calibration.stereo.width > 0) return calibration.stereo;
  StereoCalibration any;
  any.width = 640;
  any.height = 480;
  any.fx = any.fy = 500.0;
  any.cx = 320.0;
  any.cy = 240.0;
  any.baseline = 0.5;
  return any;
}

// After the start a drive with nothing but GNSS has nothing else to go by.
VehicleConfig fitted(VehicleConfig config, const Sensors& sensors) {
  if (!sensors.camera && !sensors.imu && !sensors.odometry) config.fusion.use_gnss = true;
  return config;
}

}  // namespace

Vehicle::Graph::Graph(const VehicleConfig& vehicle_config, const VehicleCalibration& calibration,
                      Sensors sensors, const runtime::DataClock& data_clock,
                      std::vector<MessageSink*> sinks, Observer observer,
                      runtime::Tracer* run_tracer, std::shared_ptr<const RoadMap> road_map)
    : config(fitted(vehicle_config, sensors)),
      clock(data_clock),
      tracer(run_tracer),
      map(std::move(road_map)),
      images(make_edge<StereoPair>(edges::camera_stereo, &stereo_bell)),
      odometry_recorded(sensors.odometry != nullptr),
      to_lidar(config.odometry == "visual-lidar" && sensors.velodyne != nullptr &&
                       !odometry_recorded
                   ? std::optional<LidarEdges>(std::in_place)
                   : std::nullopt),
      to_ppp(sensors.epochs != nullptr ? std::optional<PppEdges>(std::in_place) : std::nullopt),
      to_mapmatch(map != nullptr ? std::optional<MapMatchEdges>(std::in_place) : std::nullopt),
      raw(wants_raw(sinks)),
      camera("camera", prefetched(stages::camera, std::move(sensors.camera)),
             raw ? Edges<StereoPair>{&to_publisher.camera, &images} : Edges<StereoPair>{&images}),
      velodyne("velodyne", prefetched(stages::velodyne, std::move(sensors.velodyne)), scan_edges()),
      imu("imu", std::move(sensors.imu), {&to_fusion.imu, &to_publisher.imu}),
      gnss("gnss", std::move(sensors.gnss), to_ppp ? Edges<GnssFix>{} : fix_edges()),
      epochs("gnss", std::move(sensors.epochs),
             to_ppp ? Edges<GnssEpoch>{&to_ppp->epochs} : Edges<GnssEpoch>{}),
      wheel("wheel", std::move(sensors.wheel), {&to_fusion.wheel, &to_publisher.wheel}),
      reference("reference", std::move(sensors.reference), {&to_publisher.reference}),
      odometry("odometry", std::move(sensors.odometry),
               {&to_fusion.odometry, &to_publisher.odometry}),
      visual_log("visual log", std::move(sensors.visual),
                 to_mapmatch ? Edges<RelativeMotion>{&to_publisher.visual, &to_mapmatch->visual}
                             : Edges<RelativeMotion>{&to_publisher.visual}),
      lidar_log("lidar log", std::move(sensors.lidar), {&to_publisher.lidar}),
      stereo(stereo::StereoOdometry(camera_of(calibration), config.stereo), images, stereo_bell,
             visual_edges()),
      fusion(fusion::ReducedImuFilter(config.fusion), to_fusion, state_edges(),
             to_publisher.image_state,
             stages::stereo.budget + (to_lidar ? stages::lidar.budget : Duration::zero())),
      publisher(calibration, to_publisher, std::move(sinks), std::move(observer), describer()),
      wake_all(stop.get_token(), [this] {
        stereo_bell.ring();
        if (to_lidar) to_lidar->bell.ring();
        if (to_ppp) to_ppp->bell.ring();
        to_fusion.bell.ring();
        if (to_mapmatch) to_mapmatch->bell.ring();
      }) {
  if (to_lidar) {
    lidar.emplace(lidar::LidarOdometry(calibration.T_body_velo, config.lidar), *to_lidar,
                  to_publisher.lidar,
                  Edges<RelativeMotion>{&to_fusion.odometry, &to_publisher.odometry});
    lidar->trace_to(trace_buffer(stages::lidar.name));
  }
  if (to_ppp) {
    ppp.emplace(std::move(sensors.ppp), config.ppp.integrity_risk, *to_ppp, to_publisher.ppp,
                fix_edges());
    ppp->trace_to(trace_buffer(stages::ppp.name));
    epochs.trace_to(trace_buffer(stages::gnss.name));
  } else {
    gnss.trace_to(trace_buffer(stages::gnss.name));
    to_publisher.ppp.finish();
  }
  if (to_mapmatch) {
    mapmatch.emplace(map, config.mapmatch, *to_mapmatch, Edges<MapMatch>{&to_publisher.map_match});
    mapmatch->trace_to(trace_buffer(stages::mapmatch.name));
  }
  camera.trace_to(trace_buffer(stages::camera.name));
  velodyne.trace_to(trace_buffer(stages::velodyne.name));
  imu.trace_to(trace_buffer(stages::imu.name));
  wheel.trace_to(trace_buffer(stages::wheel.name));
  reference.trace_to(trace_buffer(stages::reference.name));
  if (odometry_recorded) {
    odometry.trace_to(trace_buffer(stages::odometry.name));
    visual_log.trace_to(trace_buffer(stages::visual_log.name));
    lidar_log.trace_to(trace_buffer(stages::lidar_log.name));
  }
  stereo.trace_to(trace_buffer(stages::stereo.name));
  fusion.trace_to(trace_buffer(stages::fusion.name));
  publisher.trace_to(trace_buffer(stages::publisher.name));
  health_trace = trace_buffer(stages::health.name);
}

Vehicle::Graph::~Graph() {
  stop.request_stop();
  wait();
}

Edges<LidarScan> Vehicle::Graph::scan_edges() {
  Edges<LidarScan> to;
  if (raw) to.push_back(&to_publisher.velodyne);
  if (to_lidar) to.push_back(&to_lidar->scans);
  return to;
}

Edges<RelativeMotion> Vehicle::Graph::visual_edges() {
  Edges<RelativeMotion> to{&to_publisher.visual};
  if (to_lidar) {
    to.push_back(&to_lidar->visual);
  } else {
    to.insert(to.end(), {&to_fusion.odometry, &to_publisher.odometry});
  }
  if (to_mapmatch) to.push_back(&to_mapmatch->visual);
  return to;
}

Edges<GnssFix> Vehicle::Graph::fix_edges() {
  return {&to_fusion.gnss, &to_publisher.gnss};
}

Edges<NavState> Vehicle::Graph::state_edges() {
  Edges<NavState> to{&to_publisher.nav_state};
  if (to_mapmatch) to.push_back(&to_mapmatch->nav_state);
  return to;
}

MatchDescriber Vehicle::Graph::describer() const {
  return [roads = map](const MapMatch& match) {
    return mapmatch::in_words(match, roads->network, roads->rules);
  };
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
        epochs.load_first(), wheel.load_first(), reference.load_first(), odometry.load_first(),
        visual_log.load_first(), lidar_log.load_first()}) {
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
  epochs.skip_until(resumed->at);
  wheel.skip_until(resumed->at);
  reference.skip_until(resumed->at);
  odometry.skip_until(resumed->at);
  visual_log.skip_until(resumed->at);
  lidar_log.skip_until(resumed->at);
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
                          [this](const std::stop_token&) { snapshots->run(first); }, [] {}),
                      snapshots->meter(), {});
}

// From the images, or as it was recorded.
void Vehicle::Graph::start_odometry() {
  if (odometry_recorded) {
    start_driver(stages::odometry, config.scheduling.odometry, odometry);
    start_driver(stages::visual_log, config.scheduling.odometry, visual_log);
    start_driver(stages::lidar_log, config.scheduling.odometry, lidar_log);
    start_thread(
        producers, stages::stereo, config.scheduling.stereo, stop.get_token(),
        [this](const std::stop_token& token) { stereo.idle(token); }, [] {});
  } else {
    start_stereo();
  }
  if (lidar) {
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
  // Of a drive with GNSS alone nobody waits for images.
  if (to_ppp && camera.absent()) return;
  monitor.watch_stage(stages::stereo, thread, stereo.meter(), {&images});
}

// The receiver's fixes, or its observations and what makes fixes from them.
void Vehicle::Graph::start_gnss() {
  if (!ppp) {
    start_driver(stages::gnss, config.scheduling.gnss, gnss);
    return;
  }
  monitor.watch(to_ppp->epochs);
  monitor.watch(to_publisher.ppp);
  start_driver(stages::gnss, config.scheduling.gnss, epochs);
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
    return;
  }
  monitor.watch_stage(
      stages::mapmatch,
      start_thread(
          producers, stages::mapmatch, config.scheduling.mapmatch, stop.get_token(),
          [this](const std::stop_token& token) { mapmatch->run(clock, begin, token); },
          [this] { mapmatch->finish(); }),
      mapmatch->meter(), {&to_mapmatch->nav_state, &to_mapmatch->visual});
}

void Vehicle::Graph::start() {
  find_first();
  for (const runtime::EdgeBase* edge : std::initializer_list<const runtime::EdgeBase*>{
           &images, &to_fusion.imu, &to_fusion.gnss, &to_fusion.wheel, &to_fusion.odometry,
           &to_publisher.imu, &to_publisher.gnss, &to_publisher.wheel, &to_publisher.reference,
           &to_publisher.visual, &to_publisher.lidar, &to_publisher.odometry,
           &to_publisher.nav_state, &to_publisher.image_state, &to_publisher.reports}) {
    monitor.watch(*edge);
  }
  if (to_mapmatch) {
    monitor.watch(to_mapmatch->nav_state);
    monitor.watch(to_mapmatch->visual);
    monitor.watch(to_publisher.map_match);
  }
  if (to_lidar) {
    monitor.watch(to_lidar->scans);
    monitor.watch(to_lidar->visual);
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
  start_gnss();
  start_driver(stages::wheel, scheduling.wheel, wheel);
  start_driver(stages::reference, scheduling.reference, reference);
  start_odometry();
  monitor.watch_stage(stages::fusion,
                      start_thread(
                          producers, stages::fusion, scheduling.fusion, stop.get_token(),
                          [this](const std::stop_token& token) { fusion.run(clock, begin, token); },
                          [this] { fusion.finish(); }),
                      fusion.meter(),
                      {&to_fusion.imu, &to_fusion.gnss, &to_fusion.wheel, &to_fusion.odometry});
  start_mapmatch();
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

void Vehicle::Graph::wait() {
  for (runtime::Thread& thread : producers) thread.join();
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
