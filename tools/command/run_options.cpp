#include "tools/command/run_options.h"

#include "tools/command/bus_option.h"
#include "tools/command/choice_option.h"
#include "tools/command/option_checks.h"

namespace maploop::tools {

void add_run_options(CLI::App* sub, RunOptions& options) {
  const auto add_file = [sub](const char* name, std::filesystem::path& file, const char* what) {
    return sub->add_option(name, file, what)->check(writable_file());
  };
  sub->add_flag("--verbose", options.verbose,
                "End with the tables of accuracy, sensors, losses, latencies and hashes, and say "
                "of every real-time setting what was granted");
  auto* record = add_file("--record", options.record, "Write every message to this LCM log");
  sub->add_flag("--record-raw", options.record_raw,
                "With the images and scans, for a replay of the whole graph (30 MB/s)")
      ->needs(record);
  auto* no_lcm = sub->add_flag("--no-lcm", options.no_lcm, "Publish nothing on LCM");
  add_lcm_url(sub, options.lcm_url)->excludes(no_lcm);
  add_file("--json", options.json, "Write all figures of the run to this file as JSON");
  add_file("--report", options.report,
           "Write a page with all of it to this file: way, errors, latencies, losses");
  add_file("--trace", options.trace,
           "Write what each thread did when to this file, for ui.perfetto.dev (of a replay that "
           "went back: since then)");
  add_file("--poses", options.states.poses,
           "Write the fused left-camera poses to this file in KITTI's format");
  add_file("--tum", options.states.tum, "The same in TUM's format, with stamps");
  add_file("--csv", options.states.csv,
           "Write the fused state every 100 ms to this file, with what its aids said");
  add_file("--nmea", options.states.nmea,
           "Write GGA, RMC, GST and HDT sentences of the fused state, once a second");
  sub->add_option("--map", options.map,
                  "OpenStreetMap file, or network file of `maploop map build`: the fused state is "
                  "matched to its roads")
      ->check(existing_file());
  add_choice(sub, "--map-mode", options.map_mode,
             "none; loose, the default where there is a map: matched, and nothing fed back; tight: "
             "the road goes back to the filter; hard-reset: position and azimuth become the "
             "matched ones");
}

}  // namespace maploop::tools
