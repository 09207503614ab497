#include "runtime/vehicle/vehicle_report.h"

#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/vehicle_graph.h"

namespace maploop::vehicle {

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
  if (odometry_recorded) add(odometry);
  r.lateness = lateness.summarize("all sensors");
  r.health = last_report.health;
  r.deadlines = last_report.deadlines;
  r.stalls = clock.stalls();
  r.stalled = clock.stalled();
  r.data_seconds = to_seconds(fusion.position() - begin);
  r.wall_seconds = to_seconds(wall);
  r.cpu_seconds = cpu;
  r.peak_memory = process_peak_memory();
  return r;
}

}  // namespace maploop::vehicle
