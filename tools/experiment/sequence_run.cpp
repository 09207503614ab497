#include "tools/experiment/sequence_run.h"

#include <stdexcept>
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

SequenceRun run_sequence(const std::filesystem::path& folder, const SequenceCase& setup,
                         const vehicle::VehicleConfig& config, vehicle::Observer observer,
                         std::shared_ptr<const vehicle::RoadMap> map) {
  SequenceRun run{vehicle::open_recording(folder / setup.sequence, config), {}, {}, {}, {}};
  const vehicle::Recording& recording = run.recording;
  run.reference = sensors::read_rows(recording.sensors(Time::max()).reference);
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (setup.end > 0.0) limit(sensors, recording.first_stamp + from_seconds(setup.end));
  observer.nav_state = [&track = run.track,
                        also = std::move(observer.nav_state)](const FusedState& state) {
    track.add(state);
    also(state);
  };
  vehicle::Vehicle vehicle(config, recording.calibration, std::move(sensors),
                           runtime::DataClock::virtual_time(), {}, std::move(observer), nullptr,
                           std::move(map));
  if (setup.outages.empty()) vehicle.start_from(vehicle::start_from_reference(recording));
  vehicle.start();
  vehicle.wait();
  run.report = vehicle.report();
  const auto score =
      fusion_score::score(run.track, run.reference, recording.outages, recording.first_stamp);
  if (!score) {
    throw std::runtime_error("sequence " + setup.sequence + " in " + setup.configuration +
                             " gave nothing to score");
  }
  run.score = *score;
  return run;
}

}  // namespace maploop::experiments
