#include "tools/live/live_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/core/realtime.h"
#include "runtime/core/trace.h"
#include "runtime/core/whole_file.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "runtime/vehicle/output/runs.h"
#include "tools/command/map_options.h"
#include "tools/command/service_manager.h"
#include "tools/command/terminal.h"
#include "tools/live/live_status.h"
#include "tools/replay/verdict.h"

namespace maploop::tools {
namespace {

constexpr int exit_failed = 1;

vehicle::VehicleConfig config_of(const LiveOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config);
  set_map(config.map, options.map, options.map_mode);
  return config;
}

// A run of days does not gather what nobody asked for.
vehicle::Observer observer_of(const LiveOptions& options, RunPass& pass, LiveStatus& status) {
  const StateFiles& s = options.states;
  const bool states = !(s.poses.empty() && s.tum.empty() && s.csv.empty() && s.nmea.empty());
  vehicle::Observer o = states || !options.report.empty() ? pass.observer() : pass.end_observer();
  o.health = [&status](const Health& health) { status.take(health); };
  return o;
}

void show(double driven, const std::string& sensors) {
  show_status(STDERR_FILENO, fmt::format("{:8.1f} s  {}  Ctrl-C ends", driven, sensors));
}

// The service manager's watchdog hears of it as long as the fusion ticks.
void wait_for_end(const vehicle::Vehicle& vehicle, double seconds, const LiveStatus& status,
                  vehicle::RunPresence* presence) {
  constexpr auto look_every = std::chrono::milliseconds(20);
  constexpr int show_every = 10;
  constexpr Duration tell_every = std::chrono::seconds(1);
  Time told = vehicle.position();
  const bool visible = is_screen(STDERR_FILENO);
  for (int i = 0; vehicle.running() && !interrupted(); ++i) {
    if (presence != nullptr) presence->update();
    const Time position = vehicle.position();
    if (position - told >= tell_every) {
      tell_service_manager("WATCHDOG=1");
      told = position;
    }
    const double driven = to_seconds(position - vehicle.first());
    if (seconds > 0.0 && driven >= seconds) break;
    if (visible && i % show_every == 0) show(driven, status.text());
    std::this_thread::sleep_for(look_every);
  }
  if (visible) show_status(STDERR_FILENO, "");
}

}  // namespace

int live(const LiveOptions& options) {
  const vehicle::VehicleConfig config = config_of(options);
  vehicle::Sensors sensors;
  sensors.live = vehicle::open_live_sensors(config);
  const VehicleCalibration calibration = vehicle::live_calibration(config);
  const auto map = vehicle::load_road_map(config.map);
  runtime::RealtimeReport readiness = runtime::prepare_process(config.memory);

  RunPass pass(calibration);
  std::vector<vehicle::MessageSink*> sinks{&pass.hashes};
  const vehicle::Run run = vehicle::new_run("live " + options.config.filename().string());
  std::unique_ptr<vehicle::LcmBus> bus;
  std::optional<vehicle::RunPresence> presence;
  if (!options.no_lcm) {
    const std::string url = vehicle::bus_url(options.lcm_url, config.lcm_url);
    bus = std::make_unique<vehicle::LcmBus>(url);
    presence.emplace(bus->lcm(), run, warn_of_another_run);
    std::cerr << "Run " << run.id << " at " << url << '\n';
    runtime::append(readiness, bus->settings());
    sinks.push_back(bus.get());
  }
  if (!options.record.empty()) {
    pass.recorder = std::make_unique<vehicle::LogRecorder>(options.record, options.record_raw,
                                                           vehicle::LogRecorder::WhenBehind::drop);
    sinks.push_back(pass.recorder.get());
  }
  std::unique_ptr<runtime::Tracer> tracer;
  if (!options.trace.empty()) {
    tracer = std::make_unique<runtime::Tracer>(config.trace);
    runtime::WholeFile(options.trace);  // one that cannot be written is said before the drive
  }

  LiveStatus status;
  note_interrupts();
  vehicle::Vehicle vehicle(config, calibration, std::move(sensors), runtime::DataClock::live(),
                           std::move(sinks), observer_of(options, pass, status), tracer.get(), map);
  vehicle.prepared(readiness);
  vehicle.start();
  std::cerr << (options.verbose ? to_text(vehicle.readiness())
                                : to_short_text(vehicle.readiness()));
  tell_service_manager("READY=1");
  wait_for_end(vehicle, options.seconds, status, presence ? &*presence : nullptr);
  tell_service_manager("STOPPING=1");
  vehicle.stop();
  vehicle.wait();

  ReplayResult result;
  result.drive = options.config.filename().string();
  result.run = run.id;
  result.live = true;
  result.configuration = config.configuration;
  result.end = pass.end;
  result.vehicle = vehicle.report();
  result.channels = pass.hashes.summary();
  result.ppp = pass.ppp;
  if (tracer) {
    result.trace = {options.trace.string(), tracer->recorded(), tracer->dropped()};
  }
  if (presence) presence->conclude(verdict_text(result));
  // The table last: whoever reads it may have gone.
  const bool written = write_all({
      [&] {
        if (tracer) tracer->write(options.trace);
      },
      [&] {
        if (!options.json.empty()) write_json(options.json, result);
      },
      [&] {
        if (result.end) write_states(options.states, pass);
      },
      [&] {
        if (options.report.empty()) return;
        write_run_report(options.report, result, pass, {}, config, map.get());
      },
  });
  std::cout << closing_text(result, options.verbose);
  const bool silent = nothing_came(result.vehicle.health);
  if (silent) {
    std::cerr << "maploop: no sensor has delivered anything; 'maploop sensors "
              << options.config.string() << "' says what each one does\n";
  }
  return silent || any_thread_failed(result) || !pass.recorded_all() || !written ? exit_failed : 0;
}

}  // namespace maploop::tools
