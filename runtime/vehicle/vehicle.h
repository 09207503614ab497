// The vehicle: which thread runs what, and which ring joins them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "estimators/fusion/initial_state.h"
#include "msgs/calibration.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "ppp/ppp_setup.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/realtime_setting.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/gnss_epoch.h"
#include "runtime/vehicle/live_corrections.h"
#include "runtime/vehicle/message_sink.h"
#include "runtime/vehicle/publisher.h"
#include "runtime/vehicle/road_map.h"
#include "runtime/vehicle/snapshot.h"
#include "runtime/vehicle/snapshot_stage.h"
#include "runtime/vehicle/vehicle_config.h"
#include "runtime/vehicle/vehicle_report.h"
#include "sensors/clock/host_clock.h"
#include "sensors/live/live_source.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Those that the vehicle listens to; null: it has none. GNSS is either fixes or observations.
struct LiveSensors {
  std::shared_ptr<const sensors::HostClock> clock;  // that they stamp with
  std::unique_ptr<sensors::LiveSource<StereoPair>> camera;
  std::unique_ptr<sensors::LiveSource<LidarScan>> velodyne;
  std::unique_ptr<sensors::LiveSource<ImuSample>> imu;
  std::unique_ptr<sensors::LiveSource<GnssFix>> gnss;
  std::unique_ptr<sensors::LiveSource<GnssEpoch>> epochs;             // as of Sensors
  std::unique_ptr<sensors::LiveSource<GnssCorrections>> corrections;  // for them
  std::shared_ptr<const ppp::PppSetup> ppp;
};

struct Sensors {
  std::unique_ptr<sensors::Source<StereoPair>> camera;
  std::unique_ptr<sensors::Source<LidarScan>> velodyne;
  std::unique_ptr<sensors::Source<ImuSample>> imu;
  std::unique_ptr<sensors::Source<GnssFix>> gnss;
  // Instead of fixes: the receiver's observations, with what the ppp thread makes fixes from.
  std::unique_ptr<sensors::Source<GnssEpoch>> epochs;
  std::shared_ptr<const ppp::PppSetup> ppp;
  std::unique_ptr<sensors::Source<WheelSpeed>> wheel;
  std::unique_ptr<sensors::Source<ReferencePose>> reference;
  // Of a recording without images: what fusion got takes the place of the camera, and of the stereo
  // and lidar threads. The other two are shown only.
  std::unique_ptr<sensors::Source<RelativeMotion>> odometry;
  std::unique_ptr<sensors::Source<RelativeMotion>> visual;
  std::unique_ptr<sensors::Source<LidarMotion>> lidar;
  // Instead of all of these, on a live clock.
  std::optional<LiveSensors> live;

  // Calls f(source) for each recorded source that is there.
  template <class F>
  void each_source(F&& f) {
    const auto there = [&f](auto& source) {
      if (source != nullptr) f(source);
    };
    there(camera);
    there(velodyne);
    there(imu);
    there(gnss);
    there(epochs);
    there(wheel);
    there(reference);
    there(odometry);
    there(visual);
    there(lidar);
  }
};

// One replay of recorded sensors through the graph. On a paced clock samples are released at their
// due times; on virtual time as fast as the graph takes them. Every channel that is derived from
// data has the same bits either way.
//
// Or a drive: on a live clock samples are released when they come, nobody waits for anything that
// is missing, and a full ring drops what is new. It ends by stop() alone.
class Vehicle {
 public:
  // `sinks` must outlive the vehicle, and so must `tracer`, to which each thread records what it
  // does; none: no trace. Without a map nothing is matched.
  Vehicle(const VehicleConfig& config, const VehicleCalibration& calibration, Sensors sensors,
          const runtime::DataClock& clock, std::vector<MessageSink*> sinks, Observer observer,
          runtime::Tracer* tracer = nullptr, std::shared_ptr<const RoadMap> map = nullptr);
  ~Vehicle();  // stops and waits

  // Slows stages down or ends them, for tests of what happens then; before start().
  void slow_down(StageDelays delays);

  // The filter starts from these values instead of a fix; before start(). Throws
  // std::invalid_argument where they cannot be.
  void start_from(const fusion::KnownStart& known);

  // Saves everything at each of these moments: data time, rounded up to the next tick of the
  // fusion. Those before the start or after the end are never taken. Before start(); more
  // than one may ask.
  void take_snapshots(std::vector<Time> moments, SnapshotHandler handler);

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

  // Waits for the end; only then report() is complete.
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
