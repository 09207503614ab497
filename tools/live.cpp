// maploop live: the whole graph on live sensors.
#include "tools/live_run.h"
#include "tools/option_checks.h"

#include <memory>

#include "tools/bus_option.h"
#include "tools/choice_option.h"
#include "tools/commands.h"

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
  sub->add_flag("--verbose", options->verbose,
                "Say of every real-time setting what was granted, and end with the tables of "
                "sensors, losses, latencies and hashes");
  auto* record =
      sub->add_option("--record", options->record, "Write every message to this LCM log");
  sub->add_flag("--record-raw", options->record_raw,
                "With the scans, for a replay of the whole graph")
      ->needs(record);
  auto* no_lcm = sub->add_flag("--no-lcm", options->no_lcm, "Publish nothing on LCM");
  add_lcm_url(sub, options->lcm_url)->excludes(no_lcm);
  sub->add_option("--map", options->map,
                  "OpenStreetMap file, or network file of `maploop map build`: the fused state is "
                  "matched to its roads")
      ->check(existing_file());
  add_choice(sub, "--map-mode", options->map_mode,
             "none; loose, the default where there is a map: matched, and nothing fed back; tight: "
             "the road goes back to the filter; hard-reset: position and azimuth become the "
             "matched ones");
  sub->add_option("--json", options->json, "Write all figures of the run to this file as JSON");
  sub->add_option("--report", options->report,
                  "Write a page with all of it to this file: way, latencies, losses");
  sub->add_option("--trace", options->trace,
                  "Write what each thread did when to this file, for ui.perfetto.dev");
  sub->add_option("--poses", options->states.poses,
                  "Write the fused left-camera poses to this file in KITTI's format");
  sub->add_option("--tum", options->states.tum, "The same in TUM's format, with stamps");
  sub->add_option("--csv", options->states.csv,
                  "Write the fused state every 100 ms to this file, with what its aids said");
  sub->add_option("--nmea", options->states.nmea,
                  "Write GGA, RMC, GST and HDT sentences of the fused state, once a second");
  sub->callback([options, &command] { command = [options] { return live(*options); }; });
}

}  // namespace maploop::tools
