// maploop live: the whole graph on live sensors.
#include "tools/command/option_checks.h"
#include "tools/live/live_run.h"

#include <memory>

#include "tools/command/commands.h"

namespace maploop::tools {

void add_live(CLI::App& app, Command& command) {
  auto options = std::make_shared<LiveOptions>();
  CLI::App* sub = app.add_subcommand(
      "live",
      "Run the graph on live sensors. Waits for none of them: what is missing is said and looked "
      "for again. Ends at Ctrl-C");
  sub->add_option("CONFIG", options->config, "TOML file whose [live] names the sensors' endpoints")
      ->required()
      ->check(existing_file());
  sub->add_option("--seconds", options->seconds, "End after so long")->check(positive_number());
  add_run_options(sub, *options);
  sub->callback([options, &command] { command = [options] { return live(*options); }; });
}

}  // namespace maploop::tools
