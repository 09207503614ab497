#include "runtime/vehicle/vehicle_report.h"

#include "runtime/core/periodic.h"
#include "runtime/vehicle/process_usage.h"
#include "runtime/vehicle/refusals.h"
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
  if (ppp) {
    add(epochs);
  } else {
    add(gnss);
  }
  if (!wheel.absent()) add(wheel);
  add(reference);
  if (odometry_recorded) {
    add(odometry);
    add(visual_log);
    add(lidar_log);
  }
  r.lateness = lateness.summarize("all sensors");
  r.health = last_report.health;
  r.deadlines = last_report.deadlines;
  r.imu_delay = last_imu_delay;
  r.stalls = clock.stalls();
  r.stalled = clock.stalled();
  r.data_seconds = to_seconds(fusion.position() - begin);
  r.wall_seconds = to_seconds(wall);
  r.cpu_seconds = cpu;
  r.peak_memory = process_peak_memory();
  return r;
}

RuntimeReport Vehicle::Graph::look(Duration elapsed) {
  const Time stamp = fusion.position();
  RuntimeReport report;
  report.stamp = report.available = stamp;
  report.health = monitor.health(stamp, elapsed, clock, readiness);
  report.health.elapsed = to_seconds(runtime::monotonic_now() - started);
  report.health.cpu = process_cpu_seconds() - cpu_at_start;
  report.health.refusals = refusals(stereo, lidar ? &*lidar : nullptr, ppp ? &*ppp : nullptr,
                                    fusion.filter_status(), mapmatch ? &*mapmatch : nullptr);
  report.deadlines = monitor.deadlines(stamp);
  return report;
}

void Vehicle::Graph::run_health(const std::stop_token& end) {
  started_all.wait();
  Time looked = begin;
  const auto say = [&] {
    const runtime::TraceSpan span(health_trace, "health");
    const MonotonicTime began = runtime::monotonic_now();
    const Time now = fusion.position();
    to_publisher.reports.push(look(now - looked), end);
    looked = now;
    health_meter.ran(runtime::monotonic_now() - began);
  };
  // In virtual time there are no rates to watch: one report at the end.
  if (clock.is_paced()) {
    const runtime::Schedule schedule{stages::health.period, stages::health.phase,
                                     stages::health.overrun};
    runtime::run_periodic(clock, begin, schedule, end, [&](const runtime::Tick& tick) {
      if (clock.keeps_time(tick.time)) {
        health_meter.woke(tick, clock, clock.due(tick.time), runtime::monotonic_now());
      }
      say();
      return true;
    });
  }
  for (;;) {
    const std::uint32_t heard = health_bell.listen();
    if (end.stop_requested()) break;
    health_bell.wait(heard);
  }
  say();
}

}  // namespace maploop::vehicle
