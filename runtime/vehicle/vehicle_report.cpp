#include "runtime/vehicle/vehicle_report.h"

#include <string_view>

#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/vehicle_graph.h"

namespace maploop::vehicle {
namespace {

// What the estimators did not use, by their own reasons.
std::vector<RefusalCount> refusals(const StereoStage& stereo, const fusion::FilterStatus& filter) {
  std::vector<RefusalCount> all;
  const auto add = [&](const Stage& stage, std::string_view reason, std::uint64_t count) {
    if (count > 0) all.push_back({std::string(stage.name), std::string(reason), count});
  };
  for (std::size_t i = 1; i < odometry_status_count; ++i) {
    const auto status = static_cast<OdometryStatus>(i);
    add(stages::stereo, to_string(status), stereo.count(status));
  }
  for (std::size_t i = 1; i < fusion::reason_count; ++i) {
    const auto reason = static_cast<fusion::Reason>(i);
    add(stages::fusion, to_string(reason), filter.refused_for(reason));
  }
  add(stages::fusion, "held, and too old before the start", filter.unused);
  add(stages::fusion, "restart: the clock jumped", filter.restarts);
  return all;
}

}  // namespace

VehicleReport Vehicle::Graph::report() const {
  VehicleReport r;
  runtime::Histogram lateness;
  const auto add = [&](const auto& driver) {
    r.sensors.push_back({driver.lateness().name(), driver.report(), driver.lateness().summary()});
    lateness.merge(driver.lateness().histogram());
  };
  add(camera);
  add(velodyne);
  add(imu);
  add(gnss);
  add(reference);
  r.lateness = lateness.summarize("all sensors");
  r.health = last_report.health;
  r.deadlines = last_report.deadlines;
  for (const Meter* meter :
       {&stereo.meter(), &fusion.meter(), &fusion.camera_path(), &fusion.imu_path()}) {
    r.misses.push_back({meter->name(), meter->misses()});
  }
  r.refusals = refusals(stereo, fusion.filter().status());
  r.stalls = clock.stalls();
  r.stalled = clock.stalled();
  r.data_seconds = to_seconds(fusion.position() - first);
  r.wall_seconds = to_seconds(wall);
  r.cpu_seconds = cpu;
  r.peak_memory = process_peak_memory();
  return r;
}

}  // namespace maploop::vehicle
