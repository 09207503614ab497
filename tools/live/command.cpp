// maploop live: the whole graph on live sensors.
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string_view>
#include <thread>
#include <utility>

#include "runtime/core/realtime.h"
#include "runtime/core/utc_discipline.h"
#include "runtime/vehicle/config/live_config.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/terminal.h"
#include "tools/live/live_status.h"
#include "tools/replay/run_output.h"

namespace maploop::tools {
namespace {

struct LiveOptions : RunOptions {
  double seconds = 0.0;  // 0: until it is stopped
};

// Tells systemd "READY=1", "WATCHDOG=1" or "STOPPING=1" (sd_notify(3)); does nothing unless a
// service manager asked for it by NOTIFY_SOCKET.
void tell_service_manager(std::string_view state) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  const std::size_t length = path != nullptr ? std::strlen(path) : 0;
  if (length == 0 || length >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path, length);
  if (path[0] == '@') address.sun_path[0] = '\0';  // an abstract one
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return;
  // If the manager is gone, there is nobody to report the failure to.
  [[maybe_unused]] const auto sent =
      sendto(fd, state.data(), state.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
             reinterpret_cast<const sockaddr*>(&address),
             static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length));
  close(fd);
}

vehicle::VehicleConfig config_of(const LiveOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config, options.settings);
  set_map(config.map, options.map, options.map_mode);
  return config;
}

// A run of days gathers only what was asked for.
vehicle::Observer observer_of(const LiveOptions& options, RunPass& pass, LiveStatus& status) {
  const bool all = options.states() || !options.report.empty();
  vehicle::Observer o = all ? pass.observer() : pass.end_observer();
  o.health = [&status](const Health& health) { status.take(health); };
  return o;
}

// Feeds the service manager's watchdog as long as the fusion ticks.
void wait_for_end(const vehicle::Vehicle& vehicle, double seconds, const LiveStatus& status,
                  RunOutput& output) {
  constexpr auto look_every = std::chrono::milliseconds(20);
  constexpr int show_every = 10;
  constexpr Duration tell_every = std::chrono::seconds(1);
  Time told = vehicle.position();
  const bool visible = is_screen(STDERR_FILENO);
  for (int i = 0; vehicle.running() && !interrupted(); ++i) {
    if (output.presence() != nullptr) output.presence()->update();
    output.car().update();
    const Time position = vehicle.position();
    if (position - told >= tell_every) {
      tell_service_manager("WATCHDOG=1");
      told = position;
    }
    const double driven = to_seconds(position - vehicle.first());
    if (seconds > 0.0 && driven >= seconds) break;
    if (visible && i % show_every == 0) {
      show_status(STDERR_FILENO, fmt::format("{:8.1f} s  {}  Ctrl-C ends", driven, status.text()));
    }
    std::this_thread::sleep_for(look_every);
  }
  if (visible) show_status(STDERR_FILENO, "");
}

// Returns the exit status: 1 when a thread failed, no sensor delivered anything, or the output is
// not complete.
int live(const LiveOptions& options) {
  const vehicle::VehicleConfig config = config_of(options);
  vehicle::Sensors sensors;
  sensors.live = vehicle::open_live_sensors(config);
  const VehicleCalibration calibration = vehicle::live_calibration(config);
  const auto map = vehicle::load_road_map(config.map);
  runtime::RealtimeReport readiness = runtime::prepare_process(config.memory);
  runtime::append(readiness, {runtime::assess_utc()});

  const std::string name = options.config.filename().string();
  RunOutput output(options, config, "live " + name);
  runtime::append(readiness, output.open_bus());
  RunPass pass;
  LiveStatus status;
  note_interrupts();
  vehicle::Observer observer = observer_of(options, pass, status);
  output.car().observe(observer);
  vehicle::Vehicle vehicle(config, calibration, std::move(sensors), runtime::DataClock::live(),
                           output.sinks(pass, vehicle::LogRecorder::WhenBehind::drop),
                           std::move(observer), output.new_tracer(), map);
  vehicle.prepared(readiness);
  output.car().recall(vehicle);
  output.take_snapshots(vehicle, pass);
  vehicle.start();
  std::cerr << (options.verbose ? to_text(vehicle.readiness())
                                : to_short_text(vehicle.readiness()));
  tell_service_manager("READY=1");
  wait_for_end(vehicle, options.seconds, status, output);
  tell_service_manager("STOPPING=1");
  vehicle.stop();
  vehicle.wait();

  ReplayResult result = output.result(vehicle, pass);
  result.drive = name;
  result.live = true;
  const bool complete = output.write(result, pass, calibration, {}, map.get());
  const bool silent = nothing_came(result.vehicle.health);
  if (silent) {
    std::cerr << "maploop: no sensor has delivered anything; 'maploop sensors "
              << options.config.string() << "' says what each one does\n";
  }
  return silent || !complete ? 1 : 0;
}

}  // namespace

void add_live(CLI::App& app, Command& command, WritePage* write_page) {
  const auto [sub, options] = add_command(
      app, command, "live",
      "Run the graph on live sensors. Waits for none of them: what is missing is said and looked "
      "for again. Ends at Ctrl-C",
      live);
  sub->add_option("CONFIG", options.config, "TOML file whose [live] names the sensors' endpoints")
      ->required()
      ->check(existing_file());
  sub->add_option("--seconds", options.seconds, "End after so long")->check(positive_number());
  add_run_options(sub, options, write_page);
}

}  // namespace maploop::tools
