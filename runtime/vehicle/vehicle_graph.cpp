#include "runtime/vehicle/vehicle_graph.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "mapmatch/reasons.h"
#include "runtime/core/realtime.h"
#include "runtime/vehicle/live_driver.h"
#include "runtime/vehicle/prefetched_source.h"
#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/replay_driver.h"

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
  const bool inertial = sensors.imu || (sensors.live && sensors.live->imu);
  if (!sensors.camera && !inertial && !sensors.odometry) config.fusion.use_gnss = true;
  return config;
}

bool has_velodyne(const Sensors& sensors) {
  return sensors.velodyne || (sensors.live && sensors.live->velodyne);
}

bool is_closed(const VehicleConfig& config) {
  return config.map.mode == MapMode::tight || config.map.mode == MapMode::hard_reset;
}

bool closes_loop(const VehicleConfig& config, const std::shared_ptr<const RoadMap>& map) {
  return map != nullptr && is_closed(config);
}

std::optional<mapmatch::FeedbackParameters> feedback_of(const VehicleConfig& config) {
  if (!is_closed(config)) return std::nullopt;
  mapmatch::FeedbackParameters parameters = config.feedback;
  parameters.hard_reset = config.map.mode == MapMode::hard_reset;
  return parameters;
}

// A hard reset has none: it is what the thesis does.
fusion::GuardParameters guard_of(const VehicleConfig& config) {
  fusion::GuardParameters parameters = config.guard;
  if (config.map.mode == MapMode::hard_reset)
    parameters.difference_gate = std::numeric_limits<double>::infinity();
  return parameters;
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
      to_lidar(config.odometry == "visual-lidar" && has_velodyne(sensors) && !odometry_recorded
                   ? std::optional<LidarEdges>(std::in_place)
                   : std::nullopt),
      to_ppp(sensors.epochs != nullptr ? std::optional<PppEdges>(std::in_place) : std::nullopt),
      to_fusion(closes_loop(config, map)),
      to_mapmatch(map != nullptr ? std::optional<MapMatchEdges>(std::in_place) : std::nullopt),
      raw(wants_raw(sinks)),
      host_clock(sensors.live ? sensors.live->clock : nullptr),
      drivers(make_drivers(sensors)),
      stereo(stereo::StereoOdometry(camera_of(calibration), config.stereo), images, stereo_bell,
             visual_edges()),
      fusion(fusion::GuardedFilter(fusion::ReducedImuFilter(config.fusion), guard_of(config)),
             to_fusion, state_edges(), to_publisher.image_state,
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
    drivers.epochs->trace_to(trace_buffer(stages::gnss.name));
  } else {
    drivers.gnss->trace_to(trace_buffer(stages::gnss.name));
    to_publisher.ppp.finish();
  }
  if (to_mapmatch) {
    Edges<MapFeedback> feedbacks;
    if (to_fusion.feedback) feedbacks = {&*to_fusion.feedback, &to_publisher.map_feedback};
    mapmatch.emplace(map, config.mapmatch, feedback_of(config), *to_mapmatch,
                     Edges<MapMatch>{&to_publisher.map_match}, feedbacks);
    mapmatch->trace_to(trace_buffer(stages::mapmatch.name));
  }
  drivers.camera->trace_to(trace_buffer(stages::camera.name));
  drivers.velodyne->trace_to(trace_buffer(stages::velodyne.name));
  drivers.imu->trace_to(trace_buffer(stages::imu.name));
  drivers.wheel->trace_to(trace_buffer(stages::wheel.name));
  drivers.reference->trace_to(trace_buffer(stages::reference.name));
  if (odometry_recorded) {
    drivers.odometry->trace_to(trace_buffer(stages::odometry.name));
    drivers.visual_log->trace_to(trace_buffer(stages::visual_log.name));
    drivers.lidar_log->trace_to(trace_buffer(stages::lidar_log.name));
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
                                  Driver<T>& driver) {
  const runtime::Thread& thread = start_thread(
      producers, stage, scheduling, stop.get_token(),
      [&](const std::stop_token& token) { driver.run(clock, token); }, [&] { driver.finish(); });
  monitor.watch_driver(stage, thread, driver.lateness(), driver.absent());
}

template <class T>
std::unique_ptr<Driver<T>> Vehicle::Graph::driver(const Stage& stage,
                                                  std::unique_ptr<sensors::Source<T>> source,
                                                  std::unique_ptr<sensors::LiveSource<T>> live,
                                                  Edges<T> to) {
  std::string name(stage.name);
  if (live != nullptr) {
    return std::make_unique<LiveDriver<T>>(std::move(name), std::move(live), std::move(to));
  }
  return std::make_unique<ReplayDriver<T>>(std::move(name), std::move(source), std::move(to));
}

Drivers Vehicle::Graph::make_drivers(Sensors& s) {
  LiveSensors live = s.live ? std::move(*s.live) : LiveSensors{};
  const auto recorded = [this]<class T>(const Stage& stage,
                                        std::unique_ptr<sensors::Source<T>>& source, Edges<T> to) {
    return driver<T>(stage, std::move(source), nullptr, std::move(to));
  };
  Edges<StereoPair> to_camera{&images};
  if (raw) to_camera.insert(to_camera.begin(), &to_publisher.camera);
  Drivers d;
  d.camera = driver<StereoPair>(stages::camera, prefetched(stages::camera, std::move(s.camera)),
                                nullptr, std::move(to_camera));
  d.velodyne =
      driver<LidarScan>(stages::velodyne, prefetched(stages::velodyne, std::move(s.velodyne)),
                        std::move(live.velodyne), scan_edges());
  d.imu = driver<ImuSample>(stages::imu, std::move(s.imu), std::move(live.imu),
                            {&to_fusion.imu, &to_publisher.imu});
  d.gnss = driver<GnssFix>(stages::gnss, std::move(s.gnss), std::move(live.gnss),
                           to_ppp ? Edges<GnssFix>{} : fix_edges());
  d.epochs = recorded(stages::gnss, s.epochs,
                      to_ppp ? Edges<GnssEpoch>{&to_ppp->epochs} : Edges<GnssEpoch>{});
  d.wheel =
      recorded(stages::wheel, s.wheel, Edges<WheelSpeed>{&to_fusion.wheel, &to_publisher.wheel});
  d.reference =
      recorded(stages::reference, s.reference, Edges<ReferencePose>{&to_publisher.reference});
  d.odometry = recorded(stages::odometry, s.odometry,
                        Edges<RelativeMotion>{&to_fusion.odometry, &to_publisher.odometry});
  Edges<RelativeMotion> to_visual{&to_publisher.visual};
  if (to_mapmatch) to_visual.push_back(&to_mapmatch->visual);
  d.visual_log = recorded(stages::visual_log, s.visual, std::move(to_visual));
  d.lidar_log = recorded(stages::lidar_log, s.lidar, Edges<LidarMotion>{&to_publisher.lidar});
  return d;
}

void Vehicle::Graph::find_first() {
  drivers.each([this](auto& driver) {
    if (const auto available = driver.load_first()) first = std::min(first, *available);
  });
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
  drivers.each([this](auto& driver) { driver.skip_until(resumed->at); });
}

// Nobody waits for a full ring either.
void Vehicle::Graph::begin_now() {
  first = begin = host_clock->now() + lead;
  for (runtime::EdgeBase* edge : all_edges()) edge->drop_when_full();
}

// But for those of snapshots; each is used.
std::vector<runtime::EdgeBase*> Vehicle::Graph::all_edges() {
  std::vector<runtime::EdgeBase*> edges{&images,
                                        &to_fusion.imu,
                                        &to_fusion.gnss,
                                        &to_fusion.wheel,
                                        &to_fusion.odometry,
                                        &to_publisher.imu,
                                        &to_publisher.gnss,
                                        &to_publisher.wheel,
                                        &to_publisher.reference,
                                        &to_publisher.visual,
                                        &to_publisher.lidar,
                                        &to_publisher.odometry,
                                        &to_publisher.nav_state,
                                        &to_publisher.image_state,
                                        &to_publisher.reports};
  if (to_mapmatch) {
    edges.insert(edges.end(),
                 {&to_mapmatch->nav_state, &to_mapmatch->visual, &to_publisher.map_match});
    if (to_fusion.feedback) {
      edges.insert(edges.end(), {&*to_fusion.feedback, &to_publisher.map_feedback});
    }
  }
  if (to_lidar) edges.insert(edges.end(), {&to_lidar->scans, &to_lidar->visual});
  if (raw) edges.insert(edges.end(), {&to_publisher.camera, &to_publisher.velodyne});
  if (to_ppp) edges.insert(edges.end(), {&to_ppp->epochs, &to_publisher.ppp});
  return edges;
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
  monitor.watch_stage(stages::stereo, thread, stereo.meter(), {&images});
}

// The receiver's fixes, or its observations and what makes fixes from them.
void Vehicle::Graph::start_gnss() {
  if (!ppp) {
    start_driver(stages::gnss, config.scheduling.gnss, *drivers.gnss);
    return;
  }
  start_driver(stages::gnss, config.scheduling.gnss, *drivers.epochs);
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
  monitor.start(begin, started);
  start_snapshots();
  const SchedulingParameters& scheduling = config.scheduling;
  start_driver(stages::camera, scheduling.camera, *drivers.camera);
  start_driver(stages::velodyne, scheduling.velodyne, *drivers.velodyne);
  start_driver(stages::imu, scheduling.imu, *drivers.imu);
  start_gnss();
  start_driver(stages::wheel, scheduling.wheel, *drivers.wheel);
  start_driver(stages::reference, scheduling.reference, *drivers.reference);
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
                          [this](const std::stop_token&) { publisher.run(begin, clock); }, [] {}),
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
