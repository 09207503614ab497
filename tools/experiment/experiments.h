// The comparisons of `maploop experiment`, one function a file.
#pragma once

#include "tools/command/commands.h"

namespace maploop::tools {

void add_map_fault_experiment(CLI::App& experiment, Command& command);
void add_match_experiment(CLI::App& experiment, Command& command);
void add_rules_experiment(CLI::App& experiment, Command& command);

}  // namespace maploop::tools
