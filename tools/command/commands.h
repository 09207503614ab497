// The subcommands of `maploop`, one file each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace maploop::tools {

// What the parsed command line asks for; returns the exit status.
using Command = std::function<int()>;

void add_calibrate(CLI::App& app, Command& command);
void add_dashboard(CLI::App& app, Command& command);
void add_doctor(CLI::App& app, Command& command);
void add_evaluate(CLI::App& app, Command& command);
void add_evaluate_match(CLI::App& evaluate, Command& command);
void add_experiment(CLI::App& app, Command& command);
void add_gnss(CLI::App& app, Command& command);
void add_live(CLI::App& app, Command& command);
void add_log(CLI::App& app, Command& command);
void add_map(CLI::App& app, Command& command);
void add_match(CLI::App& app, Command& command);
void add_odometry(CLI::App& app, Command& command);
void add_ppp(CLI::App& app, Command& command);
void add_profile(CLI::App& app, Command& command);
void add_replay(CLI::App& app, Command& command);
void add_send(CLI::App& app, Command& command);
void add_sensors(CLI::App& app, Command& command);
void add_simulate(CLI::App& app, Command& command);
void add_spy(CLI::App& app, Command& command);

}  // namespace maploop::tools
