#include "tools/experiment/sequence_run.h"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/drivers/limited_source.h"
#include "sensors/replay/reference_trajectory.h"

namespace maploop::experiments {

vehicle::VehicleConfig config_of(vehicle::VehicleConfig config, const SequenceCase& setup) {
  set_configuration(config, setup.configuration);
  if (setup.mems) {
    set_imu_grade(config, "mems");
    config.imu_noise = "mems";
  }
  config.wheel.scale_error = setup.speed_scale;
  config.gnss.seed = config.wheel.seed = config.imu_seed = setup.seed;
  config.gnss_outage = setup.outages;
  return config;
}

RecordingRun run_recording(vehicle::Recording recording, const vehicle::VehicleConfig& config,
                           const RunOptions& options, vehicle::Observer observer,
                           std::shared_ptr<const vehicle::RoadMap> map) {
  RecordingRun run{std::move(recording), {}, {}, {}};
  const vehicle::Recording& drive = run.recording;
  run.reference = sensors::read_rows(drive.sensors(Time::max()).reference);
  vehicle::Sensors sensors = drive.sensors(Time::min());
  if (options.end > 0.0) limit(sensors, drive.first_stamp + from_seconds(options.end));
  observer.nav_state = [&track = run.track,
                        also = std::move(observer.nav_state)](const FusedState& state) {
    track.add(state);
    also(state);
  };
  vehicle::Vehicle vehicle(config, drive.calibration, std::move(sensors),
                           runtime::DataClock::virtual_time(), options.sinks, std::move(observer),
                           nullptr, std::move(map));
  if (options.from_reference) vehicle.start_from(vehicle::start_from_reference(drive));
  vehicle.start();
  while (options.go_on && vehicle.running()) {
    if (!options.go_on()) vehicle.stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  vehicle.wait();
  run.report = vehicle.report();
  return run;
}

SequenceRun run_sequence(const std::filesystem::path& folder, const SequenceCase& setup,
                         const vehicle::VehicleConfig& config, vehicle::Observer observer,
                         std::shared_ptr<const vehicle::RoadMap> map) {
  SequenceRun run{
      run_recording(vehicle::open_recording(folder / setup.sequence, config), config,
                    {setup.outages.empty(), setup.end}, std::move(observer), std::move(map)),
      {}};
  const auto score = fusion_score::score(run.track, run.reference, run.recording.outages,
                                         run.recording.first_stamp);
  if (!score) {
    throw std::runtime_error("sequence " + setup.sequence + " in " + setup.configuration +
                             " gave nothing to score");
  }
  run.score = *score;
  return run;
}

}  // namespace maploop::experiments
