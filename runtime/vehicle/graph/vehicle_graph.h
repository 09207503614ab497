// What the vehicle owns: its rings, drivers, stages and threads. Only for vehicle.cpp,
// vehicle_graph.cpp, vehicle_report.cpp and vehicle_threads.cpp.
#pragma once

#include <deque>
#include <functional>
#include <latch>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/core/thread.h"
#include "runtime/vehicle/drivers/driver.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/graph/rings.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/health/health_monitor.h"
#include "runtime/vehicle/playback/snapshot_stage.h"
#include "runtime/vehicle/stages/fusion_stage.h"
#include "runtime/vehicle/stages/networks_in_use.h"
#include "runtime/vehicle/stages/preview_stage.h"

namespace maploop::vehicle {

struct SnapshotRequest {
  std::set<Time> moments;
  Duration every{};  // 0: at these moments only
  SnapshotHandler handler;

  bool wants(Time at) const {
    return moments.contains(at) ||
           (every > Duration(0) && at.time_since_epoch() % every == Duration(0));
  }
};

struct Vehicle::Graph {
  Graph(const VehicleConfig& config, const VehicleCalibration& calibration, Sensors sensors,
        const runtime::DataClock& data_clock, std::vector<MessageSink*> sinks, Observer observer,
        runtime::Tracer* tracer, std::shared_ptr<const RoadMap> road_map);
  ~Graph();

  // Construction (vehicle_graph.cpp).
  void make_drivers(Sensors& sensors);
  template <class T>
  void add_driver(const StageSpec& spec, std::unique_ptr<sensors::Source<T>> recorded,
                  std::unique_ptr<sensors::LiveSource<T>> live, Outputs<T> outputs);
  // Decodes ahead, with the scheduling of the stage that reads the samples: it needs them in time,
  // and the fusion goes first.
  template <class T>
  std::unique_ptr<sensors::Source<T>> prefetched(const StageSpec& spec, const StageSpec& reader,
                                                 std::unique_ptr<sensors::Source<T>> source);
  template <class Stage, class... Arguments>
  Stage& add_stage(Arguments&&... arguments);
  void make_stages(const VehicleCalibration& calibration,
                   const std::shared_ptr<const ppp::PppSetup>& products);
  MatchDescriber describer() const;
  runtime::TraceBuffer* trace_buffer(std::string_view thread);

  // Threads (vehicle_threads.cpp).
  void find_first();
  void begin_now();
  void start();
  void start_drivers();
  void start_stages();
  void start_snapshots();
  void start_listeners();
  // Makes it an element of `threads`; its settings become part of the readiness.
  runtime::Thread& start_thread(std::deque<runtime::Thread>& threads, const StageSpec& stage,
                                std::stop_token token, runtime::Thread::Body body,
                                std::function<void()> at_end);
  void wait();

  // Reports (vehicle_report.cpp).
  void run_health(const std::stop_token& end);
  RuntimeReport look(Duration elapsed);
  void look_at_sensors(Health& health);
  void look_at_delays(Health& health);
  VehicleReport report() const;

  // The driver or stage of that name; nullptr: this vehicle does not have it.
  const DriverBase* driver(const StageSpec& spec) const;
  GraphStage* stage(std::string_view name) const;

  VehicleConfig config;
  std::stop_source stop;
  runtime::DataClock clock;
  runtime::Tracer* tracer;          // nullptr: tracing is off
  Time first = Time::max();         // of the recording
  Time begin = Time::max();         // of this run
  std::optional<Snapshot> resumed;  // without its parts, which the stages have taken
  std::vector<SnapshotRequest> snapshot_requests;
  std::unique_ptr<SnapshotStage> snapshots;
  std::shared_ptr<const RoadMap> map;  // nullptr: no map
  const std::shared_ptr<NetworksInUse> networks = std::make_shared<NetworksInUse>();
  std::shared_ptr<LoadShedding> load;                    // of live sensors; nullptr: a replay
  std::shared_ptr<const sensors::HostClock> host_clock;  // of live sensors; nullptr: a replay

  // In the order of the declaration.
  Rings rings;
  std::vector<std::unique_ptr<DriverBase>> drivers;
  std::vector<std::unique_ptr<GraphStage>> stages;
  FusionStage* fusion = nullptr;  // one of the stages
  std::optional<PreviewStage> preview;
  Publisher publisher;
  Outputs<RuntimeReport> reports;
  HealthMonitor monitor;
  ThreadMeter health_meter{stages::health};
  runtime::TraceBuffer* health_trace = nullptr;
  runtime::RealtimeReport readiness;  // complete, and constant, from started_all on

  std::stop_callback<std::function<void()>> wake_all;
  std::deque<runtime::Thread> producers;
  std::stop_source end_preview;
  std::stop_source end_health;
  runtime::Doorbell health_bell;
  std::deque<runtime::Thread> listeners;  // they end after the producers
  std::latch started_all{1};
  MonotonicTime started{};
  Duration wall{};
  double cpu_at_start = 0.0;
  double cpu = 0.0;
  // These are known after wait().
  RuntimeReport last_report;  // of the whole run
  std::vector<Naming> named;  // by HEALTH, known at the end
};

}  // namespace maploop::vehicle
