// The subcommands of `maploop`.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>

namespace maploop::report {
struct ReplayReport;
}

namespace maploop::tools {

// Runs what the parsed command line asks for, and returns the exit status.
using Command = std::function<int()>;

// Adds a subcommand to `app`, which sets `command` if the command line names it.
using AddCommand = void(CLI::App& app, Command& command);

AddCommand add_analyze, add_calibrate, add_dashboard, add_doctor, add_evaluate, add_experiment,
    add_gnss, add_log, add_map, add_match, add_odometry, add_ppp, add_profile, add_send,
    add_sensors, add_simulate, add_spy, add_vehicle;
AddCommand add_evaluate_match;        // of `maploop evaluate`
AddCommand add_map_doubts;            // of `maploop map`
AddCommand add_calibrate_extrinsics;  // of `maploop calibrate`

// Writes the page of a run. Throws std::runtime_error naming the file if it cannot be written.
using WritePage = void(const std::filesystem::path& file, const report::ReplayReport& report);

// Adds a subcommand that runs the vehicle's graph. It has no --report if `write_page` is nullptr.
using AddRun = void(CLI::App& app, Command& command, WritePage* write_page);

AddRun add_live, add_replay;

template <class Options>
struct Added {
  CLI::App* sub;
  Options& options;  // lives as long as `sub`
};

// Adds a subcommand that calls `run` with its options.
template <class Options>
Added<Options> add_command(CLI::App& app, Command& command, const char* name, const char* what,
                           int (*run)(const Options&)) {
  const auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand(name, what);
  sub->callback([options, run, &command] { command = [options, run] { return run(*options); }; });
  return {sub, *options};
}

}  // namespace maploop::tools
