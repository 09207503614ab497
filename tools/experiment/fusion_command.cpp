// maploop experiment fusion: configurations of the filter.
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/command/option_checks.h"
#include "tools/evaluate/text_file.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/fusion_experiment.h"

namespace maploop::tools {
namespace {

struct FusionOptions {
  std::filesystem::path folder, config, html;
  int seeds = 3;
};

int compare_fusion(const FusionOptions& options) {
  vehicle::VehicleConfig config;
  if (!options.config.empty()) config = vehicle::load_vehicle_config(options.config);
  const auto cases = experiments::fusion_cases(options.folder, options.seeds);
  std::vector<experiments::FusionResult> results;
  for (const experiments::FusionCase& c : cases) {
    std::cerr << "\r" << results.size() + 1 << " of " << cases.size() << ": sequence " << c.sequence
              << ", " << c.configuration << "        " << std::flush;
    results.push_back(experiments::run(options.folder, c, config));
  }
  std::cerr << '\n';
  std::cout << experiments::to_text(results);
  if (!options.html.empty()) {
    evaluation::write_text(options.html, experiments::to_html(options.folder, results));
  }
  return 0;
}

}  // namespace

void add_fusion_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<FusionOptions>();
  CLI::App* sub = experiment.add_subcommand("fusion",
                                            "Configurations of the filter on KITTI's odometry "
                                            "sequences: dead reckoning and GNSS outages");
  sub->add_option("FOLDER", options->folder, "Folder kitti_odometry, with oxts, poses, tracks")
      ->required()
      ->check(existing_folder());
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  sub->add_option("--seeds", options->seeds, "Realizations of what is random")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_option("--html", options->html, "Write a page with tables and pictures to this file")
      ->check(writable_file());
  sub->callback([options, &command] { command = [options] { return compare_fusion(*options); }; });
}

}  // namespace maploop::tools
