// What the vehicle owns: its edges, stages and threads. For vehicle.cpp, vehicle_report.cpp
// and vehicle_threads.cpp alone.
#pragma once

#include <deque>
#include <functional>
#include <latch>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <vector>

#include "runtime/core/thread.h"
#include "runtime/vehicle/drivers.h"
#include "runtime/vehicle/fusion_stage.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/health_monitor.h"
#include "runtime/vehicle/lidar_stage.h"
#include "runtime/vehicle/mapmatch_stage.h"
#include "runtime/vehicle/ppp_stage.h"
#include "runtime/vehicle/preview_stage.h"
#include "runtime/vehicle/snapshot_stage.h"
#include "runtime/vehicle/stereo_stage.h"
#include "runtime/vehicle/vehicle.h"

namespace maploop::vehicle {

struct SnapshotWish {
  std::set<Time> moments;
  SnapshotHandler handler;
};

struct Vehicle::Graph {
  Graph(const VehicleConfig& config, const VehicleCalibration& calibration, Sensors sensors,
        const runtime::DataClock& data_clock, std::vector<MessageSink*> sinks, Observer observer,
        runtime::Tracer* tracer, std::shared_ptr<const RoadMap> road_map);
  ~Graph();

  // The driver of a recorded sensor, or of a live one where there is that.
  template <class T>
  std::unique_ptr<Driver<T>> driver(const Stage& stage, std::unique_ptr<sensors::Source<T>> source,
                                    std::unique_ptr<sensors::LiveSource<T>> live,
                                    std::vector<runtime::Edge<T>*> to);
  Drivers make_drivers(Sensors& sensors);
  void find_first();
  void begin_now();
  std::vector<runtime::EdgeBase*> all_edges();
  void start();
  void start_snapshots();
  void start_odometry();
  void start_stereo();
  void start_gnss();
  void start_mapmatch();
  void start_preview();
  std::vector<runtime::Edge<LidarScan>*> scan_edges();
  std::vector<runtime::Edge<RelativeMotion>*> visual_edges();
  std::vector<runtime::Edge<GnssFix>*> fix_edges();
  std::vector<runtime::Edge<NavState>*> state_edges();
  MatchDescriber describer() const;
  void run_health(const std::stop_token& end);
  RuntimeReport look(Duration elapsed);
  void look_at_sensors(Health& health);
  void look_at_imu_delay(Health& health);
  void wait();
  VehicleReport report() const;

  runtime::TraceBuffer* trace_buffer(std::string_view thread);
  // Decoded ahead with the scheduling of the stage that reads the samples: it needs them in time,
  // and the fusion goes first.
  template <class T>
  std::unique_ptr<sensors::Source<T>> prefetched(const Stage& stage,
                                                 const runtime::Scheduling& reader,
                                                 std::unique_ptr<sensors::Source<T>> source);
  template <class T>
  void start_driver(const Stage& stage, const runtime::Scheduling& scheduling, Driver<T>& driver);
  // Makes it an element of `threads`; its settings become part of the readiness.
  runtime::Thread& start_thread(std::deque<runtime::Thread>& threads, const Stage& stage,
                                const runtime::Scheduling& scheduling, std::stop_token token,
                                runtime::Thread::Body body, std::function<void()> at_end);

  VehicleConfig config;
  std::stop_source stop;
  runtime::DataClock clock;
  runtime::Tracer* tracer;  // nullptr: tracing is off
  runtime::TraceBuffer* health_trace = nullptr;
  Time first = Time::max();         // of the recording
  Time begin = Time::max();         // of this run
  std::optional<Snapshot> resumed;  // its parts are with the stages
  std::vector<SnapshotWish> wishes;
  std::unique_ptr<SnapshotStage> snapshots;

  std::shared_ptr<const RoadMap> map;  // nullptr: none

  // Edges, by the thread that they end at.
  runtime::Doorbell stereo_bell;
  runtime::Edge<StereoPair> images;
  bool odometry_recorded;              // instead of images
  std::optional<LidarEdges> to_lidar;  // nothing: fusion gets the visual odometry
  std::optional<PppEdges> to_ppp;      // nothing: there are no observations
  FusionEdges to_fusion;
  std::optional<MapMatchEdges> to_mapmatch;  // where there is a map
  PublisherEdges to_publisher;

  bool raw;                                              // images and scans go to the publisher too
  std::shared_ptr<const sensors::HostClock> host_clock;  // of live sensors; nullptr: a replay
  Drivers drivers;
  StereoStage stereo;
  std::optional<LidarStage> lidar;  // where there is to_lidar
  std::optional<PppStage> ppp;      // where there is to_ppp
  FusionStage fusion;
  std::optional<MapMatchStage> mapmatch;  // where there is to_mapmatch
  std::optional<PreviewStage> preview;    // where somebody may look on
  Publisher publisher;
  HealthMonitor monitor;
  ThreadMeter health_meter{stages::health};
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
  fusion::DelayEstimate last_imu_delay;
  RuntimeReport last_report;  // of the whole run
};

}  // namespace maploop::vehicle
