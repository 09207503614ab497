// maploop analyze: which deadlines can be promised, from the times of one run.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/analyze/analysis.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/options.h"
#include "tools/profile/profile.h"

namespace maploop::tools {
namespace {

struct AnalyzeOptions {
  std::filesystem::path log, config, json;
  std::vector<std::string> settings;
  analyze::AnalysisParameters parameters{
      .cpus = std::max(1, static_cast<int>(std::thread::hardware_concurrency())), .execution = {}};
};

int run(const AnalyzeOptions& options) {
  const vehicle::VehicleConfig config =
      vehicle::load_vehicle_config(options.config, options.settings);
  const analyze::Analysis analysis =
      analyze::analyze(profile::profile_of_log(options.log), config.scheduling, options.parameters);
  std::cout << analyze::to_text(analysis);
  if (!options.json.empty()) write_json_file(options.json, analyze::to_json(analysis));
  return 0;
}

}  // namespace

void add_analyze(CLI::App& app, Command& command) {
  const auto [sub, options] = add_command(
      app, command, "analyze",
      "Say which deadlines can be promised on a machine, from the times of one run there: bounds "
      "of execution, response times by priorities and CPUs, and what would keep the others",
      run);
  sub->add_option("LOG", options.log,
                  "LCM log of a run in real time, plain or .gz: of a replay without --lockstep, or "
                  "live")
      ->required();
  add_config(sub, options.config);
  add_settings(sub, options.settings);
  sub->add_option("--cpus", options.parameters.cpus, "CPUs of the machine; without it, of this one")
      ->check(CLI::Range(1, 1024));
  sub->add_option("--margin", options.parameters.execution.margin,
                  "On the longest execution, where too few were measured to fit a distribution")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  add_output(sub, "--json", options.json, "Write the same to this file as JSON");
}

}  // namespace maploop::tools
