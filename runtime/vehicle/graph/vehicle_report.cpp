#include "runtime/vehicle/graph/vehicle_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph/vehicle_graph.h"
#include "runtime/vehicle/health/process_usage.h"

namespace maploop::vehicle {

VehicleReport Vehicle::Graph::report() const {
  VehicleReport r;
  runtime::Histogram lateness;
  for (const StageSpec& spec : stages::all) {
    if (const DriverBase* driver = this->driver(spec)) {
      const runtime::Histogram& late = driver->meter().wake_up();
      r.sensors.push_back(
          {std::string(spec.name), driver->report(), late.summarize(std::string(spec.name))});
      lateness.merge(late);
    } else if (spec.expected) {
      r.sensors.push_back({std::string(spec.name), {}, {}});
    }
  }
  r.lateness = lateness.summarize("all sensors");
  r.health = last_report.health;
  r.named = named;
  r.deadlines = last_report.deadlines;
  r.calibration = fusion->filter_report().calibration;
  r.place = fusion->filter_report().status.place;
  r.here = fusion->filter_report().here;
  const bool failed = std::any_of(
      r.health.threads.begin(), r.health.threads.end(),
      [](const ThreadHealth& t) { return t.name == stages::ppp.name && !t.failure.empty(); });
  if (GraphStage* ppp = stage(stages::ppp.name); ppp != nullptr && !failed) r.ppp = ppp->kept();
  r.stalls = clock.stalls();
  r.stalled = clock.stalled();
  r.last = fusion->position();
  r.data_seconds = to_seconds(fusion->position() - begin);
  r.wall_seconds = to_seconds(wall);
  r.cpu_seconds = cpu;
  r.peak_memory = process_peak_memory();
  return r;
}

void Vehicle::Graph::look_at_sensors(Health& health) {
  for (const auto& driver : drivers) {
    std::optional<SensorHealth> sensor = driver->health();
    if (!sensor) continue;
    if (!sensor->problem.empty()) {
      health.degraded.push_back(sensor->name + ": " + sensor->endpoint + ' ' + sensor->problem);
    }
    health.sensors.push_back(std::move(*sensor));
  }
  for (const auto& stage : stages) {
    std::string degraded = stage->degraded();
    if (!degraded.empty()) health.degraded.push_back(std::move(degraded));
  }
  if (std::string shed = load->sentence(); !shed.empty())
    health.degraded.push_back(std::move(shed));
  constexpr Duration disciplined = milliseconds(10);  // a clock that is only steered stays within
  if (const Duration step = host_clock->step(); std::chrono::abs(step) > disciplined) {
    health.degraded.push_back(fmt::format(
        "this machine's clock was set by {:f} s since the start, or it slept: stamps did not "
        "follow it",
        to_seconds(step)));
  }
}

// The fusion allows for a delay of stamps that it has found; what is known beforehand is better.
void Vehicle::Graph::look_at_delays(Health& health) {
  struct Sensor {
    const char *key, *name, *against, *described;
    double harmless;  // ms
  };
  const char* const antenna =
      host_clock != nullptr ? "gnss_latency of [live]" : "delay of [vehicle.antenna]";
  const std::array<Sensor, 2> sensors{{
      {"imu_delay", "imu", "odometry", "delay of [vehicle.imu]", 20.0},  // 1/3 deg in a sharp bend
      {"gnss_delay", "gnss", "the vehicle's motion", antenna, 50.0},     // 1 m in a town
  }};
  constexpr double certain = 5.0;  // sigmas
  const fusion::SelfCalibrations& all = fusion->filter_report().calibration;
  for (const Sensor& sensor : sensors) {
    const auto delay = std::ranges::find(all, sensor.key, &fusion::CalibratedProperty::key);
    if (!delay->observed() ||
        std::abs(delay->value) < std::max(sensor.harmless, certain * delay->sigma)) {
      continue;
    }
    const bool late = delay->value > 0.0;
    health.degraded.push_back(
        fmt::format("{}: its stamps are {:.0f} +- {:.0f} ms {} against {}; {} {}", sensor.name,
                    std::abs(delay->value), delay->sigma, late ? "late" : "early", sensor.against,
                    late ? "add that to" : "take that off", sensor.described));
  }
}

RuntimeReport Vehicle::Graph::look(Duration elapsed) {
  const Time stamp = fusion->position();
  RuntimeReport report;
  report.stamp = report.available = stamp;
  report.health = monitor.health(stamp, elapsed, clock, readiness);
  report.health.elapsed = to_seconds(runtime::monotonic_now() - started);
  report.health.cpu = process_cpu_seconds() - cpu_at_start;
  for (const auto& stage : stages) {
    const std::vector<RefusalCount> refused = stage->refusals();
    report.health.refusals.insert(report.health.refusals.end(), refused.begin(), refused.end());
  }
  report.deadlines = monitor.deadlines(stamp);
  report.place = fusion->filter_report().status.place;
  report.here = fusion->filter_report().here;
  look_at_delays(report.health);
  if (host_clock != nullptr) look_at_sensors(report.health);
  return report;
}

void Vehicle::Graph::run_health(const std::stop_token& end) {
  started_all.wait();
  Time looked = begin;
  const auto say = [&] {
    const runtime::TraceSpan span(health_trace, "health");
    const MonotonicTime began = runtime::monotonic_now();
    const Time now = fusion->position();
    reports.push(look(now - looked), end);
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
