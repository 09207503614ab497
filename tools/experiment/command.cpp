// maploop experiment: comparisons on recorded drives, as tables and pages.
#include "tools/experiment/experiments.h"

namespace maploop::tools {

void add_experiment(CLI::App& app, Command& command) {
  CLI::App* experiment =
      app.add_subcommand("experiment", "Comparisons of methods on recorded drives");
  experiment->require_subcommand(1);
  add_map_fault_experiment(*experiment, command);
  add_match_experiment(*experiment, command);
  add_rules_experiment(*experiment, command);
}

}  // namespace maploop::tools
