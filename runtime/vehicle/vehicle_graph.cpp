#include "runtime/vehicle/vehicle_graph.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>
#include <utility>

#include "mapmatch/reasons.h"
#include "runtime/vehicle/gap_source.h"
#include "runtime/vehicle/live_driver.h"
#include "runtime/vehicle/prefetched_source.h"
#include "runtime/vehicle/replay_driver.h"

namespace maploop::vehicle {
namespace {

// Samples decoded ahead: longer than a hiccup of the disk.
constexpr std::size_t decoded_ahead = 6;

template <class T>
using Edges = std::vector<runtime::Edge<T>*>;

bool wants_raw(const std::vector<MessageSink*>& sinks) {
  return std::any_of(sinks.begin(), sinks.end(),
                     [](const MessageSink* sink) { return sink->wants_raw(); });
}

bool wants_preview(const std::vector<MessageSink*>& sinks) {
  return std::any_of(sinks.begin(), sinks.end(),
                     [](const MessageSink* sink) { return sink->wants_preview(); });
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
VehicleConfig fitted(VehicleConfig config, const VehicleCalibration& calibration,
                     const Sensors& sensors) {
  describe_car(config, calibration);
  const bool inertial = sensors.imu || (sensors.live && sensors.live->imu);
  const bool camera = sensors.camera || (sensors.live && sensors.live->camera);
  if (!camera && !inertial && !sensors.odometry) config.fusion.use_gnss = true;
  return config;
}

bool has_velodyne(const Sensors& sensors) {
  return sensors.velodyne || (sensors.live && sensors.live->velodyne);
}

bool has_observations(const Sensors& sensors) {
  return sensors.epochs || (sensors.live && sensors.live->epochs);
}

bool is_closed(const VehicleConfig& config) {
  return config.map.mode == MapMode::tight || config.map.mode == MapMode::hard_reset;
}

// A hard reset is the fusion's alone.
bool closes_ppp(const VehicleConfig& config, const std::shared_ptr<const RoadMap>& map) {
  return map != nullptr && config.map.mode == MapMode::tight;
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
    : config(fitted(vehicle_config, calibration, sensors)),
      clock(data_clock),
      tracer(run_tracer),
      map(std::move(road_map)),
      images(make_edge<StereoPair>(edges::camera_stereo, &stereo_bell)),
      odometry_recorded(sensors.odometry != nullptr),
      to_lidar(config.odometry == "visual-lidar" && has_velodyne(sensors) && !odometry_recorded
                   ? std::optional<LidarEdges>(std::in_place)
                   : std::nullopt),
      to_ppp(has_observations(sensors)
                 ? std::optional<PppEdges>(std::in_place, closes_ppp(config, map),
                                           sensors.live && sensors.live->corrections)
                 : std::nullopt),
      to_fusion(closes_loop(config, map)),
      to_mapmatch(map != nullptr ? std::optional<MapMatchEdges>(std::in_place) : std::nullopt),
      raw(wants_raw(sinks)),
      host_clock(sensors.live ? sensors.live->clock : nullptr),
      drivers(make_drivers(sensors)),
      stereo(stereo::StereoOdometry(camera_of(calibration), config.stereo), images, stereo_bell,
             visual_edges(), to_lidar ? &to_lidar->visual : nullptr),
      fusion(fusion::GuardedFilter(fusion::ReducedImuFilter(config.fusion), guard_of(config)),
             to_fusion, state_edges(), to_publisher.image_state,
             stages::stereo.budget + (to_lidar ? stages::lidar.budget : Duration::zero())),
      preview(config.preview.rate > 0.0 && wants_preview(sinks) && !odometry_recorded
                  ? std::optional<PreviewStage>(std::in_place, config.preview,
                                                calibration.T_body_velo, to_publisher.preview)
                  : std::nullopt),
      publisher(calibration, to_publisher, std::move(sinks), std::move(observer), describer()),
      wake_all(stop.get_token(), [this] {
        stereo_bell.ring();
        if (to_lidar) to_lidar->bell.ring();
        if (to_ppp) to_ppp->bell.ring();
        to_fusion.bell.ring();
        if (to_mapmatch) to_mapmatch->bell.ring();
      }) {
  if (to_lidar) {
    lidar.emplace(lidar::LidarOdometry(calibration.T_body_velo, config.lidar),
                  lidar::DisparityCorrection(config.lidar), *to_lidar, to_publisher.lidar,
                  Edges<RelativeMotion>{&to_fusion.odometry, &to_publisher.odometry});
    lidar->trace_to(trace_buffer(stages::lidar.name));
  }
  if (preview) {
    stereo.show_to(preview->image());
    if (lidar) lidar->show_to(preview->scan(), static_cast<std::size_t>(config.preview.points));
  }
  if (to_ppp) {
    ppp.emplace(sensors.live ? sensors.live->ppp : sensors.ppp, config.ppp.integrity_risk, *to_ppp,
                to_publisher.ppp, fix_edges());
    ppp->trace_to(trace_buffer(stages::ppp.name));
    drivers.epochs->trace_to(trace_buffer(stages::gnss.name));
    if (to_ppp->corrections) drivers.corrections->trace_to(trace_buffer(stages::corrections.name));
  } else {
    drivers.gnss->trace_to(trace_buffer(stages::gnss.name));
    to_publisher.ppp.finish();
  }
  if (to_mapmatch) {
    Edges<MapFeedback> feedbacks;
    if (to_fusion.feedback) feedbacks = {&*to_fusion.feedback, &to_publisher.map_feedback};
    if (to_ppp && to_ppp->feedback) feedbacks.push_back(&*to_ppp->feedback);
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
  if (!to_lidar) to.insert(to.end(), {&to_fusion.odometry, &to_publisher.odometry});
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
    const Stage& stage, const runtime::Scheduling& reader,
    std::unique_ptr<sensors::Source<T>> source) {
  if (source == nullptr) return nullptr;
  const std::string name = std::string(stage.name) + " loader";
  // A reader with a budget of its own has it for itself.
  const bool shared = reader.policy != runtime::SchedulingPolicy::deadline;
  return std::make_unique<PrefetchedSource<T>>(
      name, clock.is_paced() && shared ? reader : runtime::Scheduling{}, std::move(source),
      decoded_ahead, stop.get_token(), trace_buffer(name));
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
  leave_out_leaps(s);
  LiveSensors none;
  LiveSensors& live = s.live ? *s.live : none;
  const auto recorded = [this]<class T>(const Stage& stage,
                                        std::unique_ptr<sensors::Source<T>>& source, Edges<T> to) {
    return driver<T>(stage, std::move(source), nullptr, std::move(to));
  };
  Edges<StereoPair> to_camera{&images};
  if (raw) to_camera.insert(to_camera.begin(), &to_publisher.camera);
  Drivers d;
  d.camera = driver<StereoPair>(
      stages::camera, prefetched(stages::camera, config.scheduling.stereo, std::move(s.camera)),
      std::move(live.camera), std::move(to_camera));
  d.velodyne = driver<LidarScan>(
      stages::velodyne,
      prefetched(stages::velodyne, config.scheduling.lidar, std::move(s.velodyne)),
      std::move(live.velodyne), scan_edges());
  d.imu = driver<ImuSample>(stages::imu, std::move(s.imu), std::move(live.imu),
                            {&to_fusion.imu, &to_publisher.imu});
  d.gnss = driver<GnssFix>(stages::gnss, std::move(s.gnss), std::move(live.gnss),
                           to_ppp ? Edges<GnssFix>{} : fix_edges());
  d.epochs = driver<GnssEpoch>(stages::gnss, std::move(s.epochs), std::move(live.epochs),
                               to_ppp ? Edges<GnssEpoch>{&to_ppp->epochs} : Edges<GnssEpoch>{});
  d.corrections = driver<GnssCorrections>(stages::corrections, nullptr, std::move(live.corrections),
                                          to_ppp && to_ppp->corrections
                                              ? Edges<GnssCorrections>{&*to_ppp->corrections}
                                              : Edges<GnssCorrections>{});
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
  if (preview) edges.push_back(&to_publisher.preview);
  if (to_ppp) edges.insert(edges.end(), {&to_ppp->epochs, &to_publisher.ppp});
  if (to_ppp && to_ppp->feedback) edges.push_back(&*to_ppp->feedback);
  if (to_ppp && to_ppp->corrections) edges.push_back(&*to_ppp->corrections);
  return edges;
}

}  // namespace maploop::vehicle
