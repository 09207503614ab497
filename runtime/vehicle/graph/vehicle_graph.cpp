#include "runtime/vehicle/graph/vehicle_graph.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "estimators/fusion/configuration.h"
#include "mapmatch/reasons.h"
#include "runtime/vehicle/drivers/gap_source.h"
#include "runtime/vehicle/drivers/live_driver.h"
#include "runtime/vehicle/drivers/prefetched_source.h"
#include "runtime/vehicle/drivers/replay_driver.h"
#include "runtime/vehicle/drivers/sensor_delays.h"
#include "runtime/vehicle/drivers/shedding_source.h"
#include "runtime/vehicle/stages/lidar_stage.h"
#include "runtime/vehicle/stages/mapmatch_stage.h"
#include "runtime/vehicle/stages/ppp_stage.h"
#include "runtime/vehicle/stages/stereo_stage.h"

namespace maploop::vehicle {
namespace {

// A drive with GNSS alone uses it after the start too: nothing else gives it a position.
VehicleConfig adapt_to_sensors(VehicleConfig config, const VehicleCalibration& calibration,
                               const Sensors& sensors) {
  describe_car(config, calibration);
  const bool inertial = sensors.imu || (sensors.live && sensors.live->imu);
  const bool camera = sensors.camera || (sensors.live && sensors.live->camera);
  if (!camera && !inertial && !sensors.odometry) config.fusion.use_gnss = true;
  // A receiver stamps its observations by the time of GNSS.
  if (sensors.epochs || (sensors.live && sensors.live->epochs))
    config.fusion.gnss_delay_sigma = 0.0;
  if (config.configuration == "auto" && inertial && !camera && !sensors.odometry) {
    fusion::apply(fusion::configuration(sensors.wheel ? "GNSS+RISS" : "GNSS+RI"), config.fusion);
  }
  return config;
}

bool feeds_back(const VehicleConfig& config) {
  return config.map.mode == MapMode::tight || config.map.mode == MapMode::hard_reset;
}

// Which threads of the declaration this vehicle has.
std::set<std::string_view> stages_of(const VehicleConfig& config, const Sensors& sensors,
                                     const std::vector<MessageSink*>& sinks, bool map) {
  const LiveSensors none;
  const LiveSensors& live = sensors.live ? *sensors.live : none;
  std::set<std::string_view> names;
  const auto add = [&names](const StageSpec& stage, bool there) {
    if (there) names.insert(stage.name);
  };
  const bool camera = sensors.camera || live.camera;
  const bool velodyne = sensors.velodyne || live.velodyne;
  const bool epochs = sensors.epochs || live.epochs;
  const bool previewed = std::any_of(sinks.begin(), sinks.end(),
                                     [](const MessageSink* sink) { return sink->wants_preview(); });
  add(stages::camera, camera);
  add(stages::velodyne, velodyne);
  add(stages::imu, sensors.imu || live.imu);
  add(stages::gnss, epochs || sensors.gnss || live.gnss);
  add(stages::corrections, live.corrections && epochs);
  add(stages::wheel, sensors.wheel != nullptr);
  add(stages::reference, sensors.reference != nullptr);
  add(stages::odometry, sensors.odometry != nullptr);
  add(stages::visual_log, sensors.odometry && sensors.visual);
  add(stages::lidar_log, sensors.odometry && sensors.lidar);
  add(stages::stereo, camera && !sensors.odometry);
  add(stages::lidar, velodyne && !sensors.odometry && config.odometry == "visual-lidar");
  add(stages::ppp, epochs);
  add(stages::fusion, true);
  add(stages::mapmatch, map);
  add(stages::preview, previewed && config.preview.rate > 0.0 && !sensors.odometry);
  add(stages::publisher, true);
  add(stages::health, true);
  return names;
}

std::set<RingNeeds> needs_met(const VehicleConfig& config, const std::vector<MessageSink*>& sinks) {
  std::set<RingNeeds> met;
  if (std::any_of(sinks.begin(), sinks.end(),
                  [](const MessageSink* sink) { return sink->wants_raw(); })) {
    met.insert(RingNeeds::raw_log);
  }
  if (feeds_back(config)) met.insert(RingNeeds::feedback);
  // Only the fusion can be reset hard.
  if (config.map.mode == MapMode::tight) met.insert(RingNeeds::ppp_feedback);
  if (config.ppp.filter.carried_by_motion) met.insert(RingNeeds::carried);
  return met;
}

std::optional<mapmatch::FeedbackParameters> feedback_of(const VehicleConfig& config) {
  if (!feeds_back(config)) return std::nullopt;
  mapmatch::FeedbackParameters parameters = config.feedback;
  parameters.hard_reset = config.map.mode == MapMode::hard_reset;
  return parameters;
}

// The hard reset of the thesis has no guard.
fusion::GuardParameters guard_of(const VehicleConfig& config) {
  fusion::GuardParameters parameters = config.guard;
  if (config.map.mode == MapMode::hard_reset)
    parameters.difference_gate = std::numeric_limits<double>::infinity();
  return parameters;
}

template <class T>
std::unique_ptr<sensors::LiveSource<T>> shedding(std::unique_ptr<sensors::LiveSource<T>> source,
                                                 std::shared_ptr<const LoadShedding> load) {
  return std::make_unique<SheddingSource<T>>(std::move(source), std::move(load));
}

}  // namespace

Vehicle::Graph::Graph(const VehicleConfig& vehicle_config, const VehicleCalibration& calibration,
                      Sensors sensors, const runtime::DataClock& data_clock,
                      std::vector<MessageSink*> sinks, Observer observer,
                      runtime::Tracer* run_tracer, std::shared_ptr<const RoadMap> road_map)
    : config(adapt_to_sensors(vehicle_config, calibration, sensors)),
      clock(data_clock),
      tracer(run_tracer),
      map(std::move(road_map)),
      host_clock(sensors.live ? sensors.live->clock : nullptr),
      rings(rings::all, stages_of(config, sensors, sinks, map != nullptr),
            needs_met(config, sinks)),
      publisher(calibration, rings, std::move(sinks), std::move(observer), describer()),
      reports(rings.outputs(rings::health_publisher)),
      wake_all(stop.get_token(), [this] {
        for (const auto& stage : stages) stage->wake();
      }) {
  const std::shared_ptr<const ppp::PppSetup> products =
      sensors.live ? sensors.live->ppp : sensors.ppp;
  make_drivers(sensors);
  make_stages(calibration, products);
  rings.check();
  publisher.trace_to(trace_buffer(stages::publisher.name));
  health_trace = trace_buffer(stages::health.name);
}

Vehicle::Graph::~Graph() {
  stop.request_stop();
  wait();
}

MatchDescriber Vehicle::Graph::describer() const {
  return [roads = map, networks = networks](const MapMatch& match) {
    const auto network = networks->at(match.stamp);
    return network ? mapmatch::in_words(match, *network, roads->rules) : MapMatchWords{};
  };
}

runtime::TraceBuffer* Vehicle::Graph::trace_buffer(std::string_view thread) {
  return tracer != nullptr ? &tracer->thread(std::string(thread)) : nullptr;
}

const DriverBase* Vehicle::Graph::driver(const StageSpec& spec) const {
  for (const auto& driver : drivers) {
    if (driver->spec().name == spec.name) return driver.get();
  }
  return nullptr;
}

GraphStage* Vehicle::Graph::stage(std::string_view name) const {
  for (const auto& stage : stages) {
    if (stage->spec().name == name) return stage.get();
  }
  return nullptr;
}

template <class T>
std::unique_ptr<sensors::Source<T>> Vehicle::Graph::prefetched(
    const StageSpec& spec, const StageSpec& reader, std::unique_ptr<sensors::Source<T>> source) {
  if (source == nullptr) return nullptr;
  const std::string name = std::string(spec.name) + " loader";
  // A reader under SCHED_DEADLINE does not share its budget.
  const runtime::Scheduling& how = scheduling_of(config.scheduling, reader);
  const bool shared = how.policy != runtime::SchedulingPolicy::deadline;
  return std::make_unique<PrefetchedSource<T>>(
      name, clock.is_paced() && shared ? how : runtime::Scheduling{}, std::move(source),
      rings::decoded_ahead, stop.get_token(), trace_buffer(name));
}

template <class T>
void Vehicle::Graph::add_driver(const StageSpec& spec, std::unique_ptr<sensors::Source<T>> recorded,
                                std::unique_ptr<sensors::LiveSource<T>> live, Outputs<T> outputs) {
  if (live != nullptr) {
    drivers.push_back(std::make_unique<LiveDriver<T>>(spec, std::move(live), std::move(outputs)));
  } else if (recorded != nullptr) {
    drivers.push_back(
        std::make_unique<ReplayDriver<T>>(spec, std::move(recorded), std::move(outputs)));
  } else {
    return;
  }
  drivers.back()->trace_to(trace_buffer(spec.name));
}

void Vehicle::Graph::make_drivers(Sensors& s) {
  leave_out_leaps(s);
  LiveSensors none;
  LiveSensors& live = s.live ? *s.live : none;
  if (s.live) {
    load = std::make_shared<LoadShedding>(config.overload, live.velodyne != nullptr,
                                          live.camera != nullptr);
    if (live.camera) live.camera = shedding(std::move(live.camera), load);
    if (live.velodyne) live.velodyne = shedding(std::move(live.velodyne), load);
  }
  add_driver<StereoPair>(
      stages::camera, prefetched(stages::camera, stages::stereo, std::move(s.camera)),
      std::move(live.camera), rings.outputs(rings::camera_publisher, rings::camera_stereo));
  add_driver<LidarScan>(
      stages::velodyne, prefetched(stages::velodyne, stages::lidar, std::move(s.velodyne)),
      std::move(live.velodyne), rings.outputs(rings::velodyne_publisher, rings::velodyne_lidar));
  add_driver(stages::imu, std::move(s.imu), std::move(live.imu),
             rings.outputs(rings::imu_fusion, rings::imu_publisher));
  if (rings.has(stages::ppp)) {
    add_driver(stages::gnss, std::move(s.epochs), std::move(live.epochs),
               rings.outputs(rings::gnss_ppp));
    add_driver(stages::corrections, {}, std::move(live.corrections),
               rings.outputs(rings::corrections_ppp));
  } else {
    add_driver(stages::gnss, std::move(s.gnss), std::move(live.gnss),
               rings.outputs(rings::gnss_fusion, rings::gnss_publisher));
  }
  add_driver(stages::wheel, std::move(s.wheel), {},
             rings.outputs(rings::wheel_fusion, rings::wheel_publisher));
  add_driver(stages::reference, std::move(s.reference), {},
             rings.outputs(rings::reference_publisher));
  if (!rings.has(stages::odometry)) return;
  add_driver(stages::odometry, std::move(s.odometry), {},
             rings.outputs(rings::odometry_fusion, rings::odometry_publisher));
  add_driver(stages::visual_log, std::move(s.visual), {},
             rings.outputs(rings::visual_log_publisher, rings::visual_log_mapmatch));
  add_driver(stages::lidar_log, std::move(s.lidar), {}, rings.outputs(rings::lidar_log_publisher));
}

template <class Stage, class... Arguments>
Stage& Vehicle::Graph::add_stage(Arguments&&... arguments) {
  auto made = std::make_unique<Stage>(rings, std::forward<Arguments>(arguments)...);
  Stage& stage = *made;
  stages.push_back(std::move(made));
  stage.trace_to(trace_buffer(stage.spec().name));
  return stage;
}

void Vehicle::Graph::make_stages(const VehicleCalibration& calibration,
                                 const std::shared_ptr<const ppp::PppSetup>& products) {
  if (rings.has(stages::preview)) preview.emplace(rings, config.preview, calibration.T_body_velo);
  if (rings.has(stages::stereo)) {
    auto& stereo =
        add_stage<StereoStage>(stereo::StereoOdometry(calibration.stereo, config.stereo));
    stereo.tell_load(load);
    if (preview) stereo.show_to(preview->image());
  }
  if (rings.has(stages::lidar)) {
    auto& lidar = add_stage<LidarStage>(
        lidar::VisualLidarOdometer(calibration.T_body_velo, config.lidar), delays_of(config));
    lidar.tell_load(load);
    if (preview) lidar.show_to(preview->scan(), static_cast<std::size_t>(config.preview.points));
  }
  if (rings.has(stages::ppp))
    add_stage<PppStage>(products, config.ppp.integrity_risk, config.fusion);
  const Duration odometry_budget =
      stages::stereo.budget + (rings.has(stages::lidar) ? stages::lidar.budget : Duration::zero());
  fusion = &add_stage<FusionStage>(
      fusion::GuardedFilter(fusion::ReducedImuFilter(config.fusion), guard_of(config)),
      fusion::ProtectionMonitor(config.protection), odometry_budget);
  if (rings.has(stages::mapmatch))
    add_stage<MapMatchStage>(map, networks, config.mapmatch, feedback_of(config));
}

}  // namespace maploop::vehicle
