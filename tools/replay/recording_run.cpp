#include "tools/replay/recording_run.h"

#include <chrono>
#include <thread>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/drivers/limited_source.h"
#include "sensors/replay/reference_trajectory.h"

namespace maploop::tools {

RecordingRun run_recording(vehicle::Recording recording, const vehicle::VehicleConfig& config,
                           const RecordingRunOptions& options, vehicle::Observer observer,
                           std::shared_ptr<const vehicle::RoadMap> map) {
  RecordingRun run{std::move(recording), {}, {}};
  const vehicle::Recording& drive = run.recording;
  run.reference = sensors::read_rows(drive.sensors(Time::max()).reference);
  vehicle::Sensors sensors = drive.sensors(Time::min());
  if (options.end > 0.0) limit(sensors, drive.first_stamp + from_seconds(options.end));
  vehicle::Vehicle vehicle(config, drive.calibration, std::move(sensors),
                           runtime::DataClock::virtual_time(), options.sinks, std::move(observer),
                           nullptr, std::move(map));
  vehicle.start();
  while (options.go_on && vehicle.running()) {
    if (!options.go_on()) vehicle.stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  vehicle.wait();
  run.report = vehicle.report();
  return run;
}

}  // namespace maploop::tools
