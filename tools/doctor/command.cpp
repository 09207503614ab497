// maploop doctor: how ready this machine is for real time, without a drive.
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/core/realtime.h"
#include "runtime/core/thread.h"
#include "runtime/vehicle/config/scheduling_config.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/options.h"
#include "tools/replay/figures.h"

namespace maploop::tools {
namespace {

struct DoctorOptions {
  std::filesystem::path config;
  std::filesystem::path json;
  std::string lcm_url;
};

// Asks the kernel for each thread of the graph as a paced replay would.
void ask_for_threads(const vehicle::VehicleConfig& config, runtime::RealtimeReport& report) {
  for (const vehicle::ScheduledThread& asked : vehicle::scheduled_threads()) {
    const runtime::Thread thread(
        asked.key, config.scheduling.*asked.scheduling, {}, [](const std::stop_token&) {}, [] {});
    runtime::append(report, thread.settings());
  }
}

std::vector<RealtimeSetting> ask_for_bus(const std::string& url) {
  try {
    return vehicle::LcmBus(url).settings();
  } catch (const std::runtime_error& e) {
    return {{"LCM: bus", url, "none", Verdict::refused, e.what(),
             "correct --lcm-url or the route, or run maploop replay --no-lcm"}};
  }
}

int doctor(const DoctorOptions& options) {
  vehicle::VehicleConfig config;
  if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
  runtime::RealtimeReport report = runtime::prepare_process(config.memory);
  ask_for_threads(config, report);
  runtime::append(report, ask_for_bus(vehicle::bus_url(options.lcm_url, config.lcm_url)));
  std::cout << runtime::to_text(report);
  if (!options.json.empty()) {
    write_json_file(options.json, {{"all_granted", report.all_granted()},
                                   {"settings", web::list(setting_columns, report.settings)}});
  }
  return 0;
}

}  // namespace

void add_doctor(CLI::App& app, Command& command) {
  const auto [sub, options] =
      add_command(app, command, "doctor",
                  "Ask this machine for all that a replay in real time asks for, and say what it "
                  "grants, what not, why, and what to do",
                  doctor);
  add_config(sub, options.config);
  add_lcm_url(sub, options.lcm_url);
  add_output(sub, "--json", options.json, "Write the report to this file as JSON");
}

}  // namespace maploop::tools
