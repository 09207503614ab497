// maploop experiment map: the map in the loop.
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include "mapmatch/network_file.h"
#include "tools/evaluation/text_file.h"
#include "tools/experiments.h"
#include "tools/experiments/map_experiment.h"

namespace maploop::tools {
namespace {

struct MapOptions {
  std::filesystem::path map, folder, config, html;
  std::vector<std::string> sequences{"00", "01", "02", "03", "04", "06", "08", "10"};
  std::vector<std::string> modes{"none", "loose", "tight", "hard-reset"};
  std::vector<std::string> outages{"10:end"};
  bool verbose = false;
  int seeds = 1;
};

int compare_modes(const MapOptions& options) {
  experiments::MapSetting setting;
  if (!options.config.empty()) setting.config = vehicle::load_vehicle_config(options.config);
  setting.folder = options.folder;
  const mapmatch::RoadNetwork network(mapmatch::open_network(options.map));
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  setting.network = &network;
  setting.rules = &rules;
  for (const std::string& sequence : options.sequences) {
    for (const std::string& outage : options.outages)
      for (const std::string& mode : options.modes)
        for (int seed = 1; seed <= options.seeds; ++seed) {
          experiments::MapCase c;
          c.sequence = sequence;
          c.mode = experiments::map_mode(mode);
          c.outages = outage;
          c.seed = seed;
          const experiments::MapResult r = experiments::run(setting, c);
          const auto& e = r.score.outages.empty() ? r.score.whole : r.score.outages[0].errors;
          std::printf("%s %-10s %d rmse %6.2f max %6.2f (%.3f %%) az %.2f nees %.2f link %.2f/%.2f",
                      sequence.c_str(), mode.c_str(), seed, e.rmse, e.max,
                      100.0 * e.rmse / e.distance, e.azimuth_rms, e.nees_mean,
                      100 * r.match.certain.share(), 100 * r.match.all.share());
          std::printf(" gates %lu/%lu |", r.status.refused_for(fusion::Reason::line_gate),
                      r.status.refused_for(fusion::Reason::link_azimuth_gate));
          for (std::size_t i = 0; i < r.reasons.size(); ++i) std::printf(" %zu", r.reasons[i]);
          std::printf("\n");
          std::fflush(stdout);
          if (options.verbose)
            for (const auto& s : r.samples)
              std::printf(
                  "  t %.1f err %.2f %.2f along %.2f cross %.2f az %.2f sigma %.2f nees %.2f P "
                  "%.2f %s\n",
                  s.time, s.error.x(), s.error.y(),
                  s.error.x() * std::sin(s.azimuth) + s.error.y() * std::cos(s.azimuth),
                  s.error.x() * std::cos(s.azimuth) - s.error.y() * std::sin(s.azimuth),
                  s.azimuth_error * 57.3, s.sigma, s.nees, s.probability,
                  std::string(to_string(s.reason)).c_str());
        }
  }
  return 0;
}

}  // namespace

void add_map_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* sub = experiment.add_subcommand("map", "The map in the loop");
  sub->add_option("MAP", options->map, "OpenStreetMap file, or a network file")->required();
  sub->add_option("FOLDER", options->folder, "Folder kitti_odometry")
      ->required()
      ->check(CLI::ExistingDirectory);
  sub->add_option("--sequences", options->sequences, "Which of them")->delimiter(',');
  sub->add_option("--modes", options->modes, "Which of them")->delimiter(',');
  sub->add_option("--gnss-outage", options->outages, "Which of them")->delimiter(';');
  sub->add_option("--seeds", options->seeds, "Realizations of what is random");
  sub->add_flag("--verbose", options->verbose);
  sub->callback([options, &command] { command = [options] { return compare_modes(*options); }; });
}

}  // namespace maploop::tools
