// The vehicle: which thread runs what, and which ring joins them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "estimators/fusion/initial_state.h"
#include "estimators/fusion/last_place.h"
#include "msgs/calibration.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/realtime_setting.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/faults/fault_delay.h"
#include "runtime/vehicle/graph/sensors.h"
#include "runtime/vehicle/graph/vehicle_report.h"
#include "runtime/vehicle/output/message_sink.h"
#include "runtime/vehicle/output/publisher.h"
#include "runtime/vehicle/playback/snapshot.h"
#include "runtime/vehicle/playback/snapshot_stage.h"
#include "runtime/vehicle/stages/road_map.h"

namespace maploop::vehicle {

// Replays recorded sensors through the graph. On a paced clock samples are released at their due
// times, on virtual time as fast as the graph takes them. Every channel that is derived from data
// has the same bits either way.
//
// On a live clock the vehicle drives: samples are released when they come, no stage waits for
// missing samples, and a full ring drops new ones. Only stop() ends it.
class Vehicle {
 public:
  // `sinks` must outlive the vehicle, and so must `tracer`, to which each thread records what it
  // does; none: no trace. Without a map nothing is matched.
  Vehicle(const VehicleConfig& config, const VehicleCalibration& calibration, Sensors sensors,
          const runtime::DataClock& clock, std::vector<MessageSink*> sinks, Observer observer,
          runtime::Tracer* tracer = nullptr, std::shared_ptr<const RoadMap> map = nullptr);
  ~Vehicle();  // stops and waits

  // Slows stages down or ends them, for tests of what happens then; before start().
  void slow_down(const StageDelays& delays);

  // The filter uses what an earlier drive has estimated of the car; before start_from() and
  // start().
  void recall(const fusion::RememberedCalibration& remembered);

  // The filter starts where the last run ended, unless this is too long ago, and forgets it if the
  // first fix contradicts it (fusion::PlaceUse); before start().
  void recall(const fusion::LastPlace& place);

  // The stage takes of an earlier run's snapshot of it what still helps on other data; before
  // start(). Throws ArchiveError that says what does not fit.
  void recall(const StageSpec& stage, std::span<const std::uint8_t> saved);

  // Whether this vehicle runs the stage.
  bool has(const StageSpec& stage) const;

  // The filter starts from these values instead of a fix; before start(). Throws
  // std::invalid_argument where they cannot be.
  void start_from(const fusion::KnownStart& known);

  // Saves everything at each of these moments: data time, rounded up to the next tick of the
  // fusion. Those before the start or after the end are never taken. Before start(); more
  // than one may ask.
  void take_snapshots(std::vector<Time> moments, SnapshotHandler handler);
  // The same at all multiples of a period since 1970. All who ask for that give the same period.
  void take_snapshots(Duration every, SnapshotHandler handler);

  // Goes on from a snapshot of the same recording: what is sent from then on has the bits of a run
  // that came there from the start. Before start(). Throws ArchiveError that says what does not
  // fit.
  void resume(const Snapshot& snapshot);

  // What prepare_process() and the like have said, for readiness() and HEALTH; before start().
  void prepared(const runtime::RealtimeReport& report);

  // Starts every thread. Throws std::runtime_error when no sensor has a single sample to replay.
  void start();

  // What was prepared, and, after start(), what each thread was granted.
  const runtime::RealtimeReport& readiness() const;

  // Asks every thread to end; any thread may call it. What was produced so far is still published.
  void stop();

  // False once everything has ended by itself or after stop().
  bool running() const;

  // Waits for the end. Only then may report() be called.
  void wait();
  VehicleReport report() const;

  // Data time of the last tick of the fusion, and of the recording's first sample.
  Time position() const;
  Time first() const;

  // When the next image, or the next sample of any sensor, becomes available; Time::max() after the
  // last one.
  Time next_image() const;
  Time next_sample() const;

  // So far, of all threads.
  std::uint64_t deadline_misses() const;

  runtime::DataClock& clock();

 private:
  struct Graph;
  std::unique_ptr<Graph> graph_;
};

}  // namespace maploop::vehicle
