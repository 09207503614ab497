// maploop experiment odometry: methods of visual odometry on the same frames.
#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/command/option_checks.h"
#include "tools/evaluate/text_file.h"
#include "tools/experiment/experiments.h"
#include "tools/odometry/odometry_input.h"
#include "tools/odometry/stereo_comparison.h"

namespace maploop::tools {
namespace {

struct Options {
  std::filesystem::path input, config, html, truth;
  odometry::FrameRange frames;
};

int compare_odometry(const Options& options) {
  const odometry::InputFiles files{options.input, options.config, {}};
  const auto truth = options.truth.empty() ? odometry::read_truth(files)
                                           : evaluation::read_trajectory(options.truth);
  odometry::Comparison comparison = odometry::stereo_comparison();
  for (const odometry::Variant& variant :
       odometry::variants(std::filesystem::is_directory(options.input),
                          std::filesystem::is_directory(options.input / "velodyne_points"))) {
    std::cerr << variant.name << " ...\n";
    comparison.methods.push_back(odometry::run_variant(variant, files, options.frames, truth));
  }
  std::cout << to_text(comparison);
  if (!options.html.empty())
    evaluation::write_text(
        options.html,
        to_html(comparison, "Visual odometry on " + options.input.filename().string()));
  return 0;
}

}  // namespace

void add_odometry_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = experiment.add_subcommand(
      "odometry",
      "Tracking against matching; 3D-2D, with and without a window, against 3D-3D and 2D-2D; "
      "and who says what the disparities lack");
  sub->add_option("DRIVE", options->input,
                  "Folder of a KITTI raw drive, or recorded tracks (<drive>.csv[.gz])")
      ->required()
      ->check(existing_path());
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  sub->add_option("--truth", options->truth,
                  "Stamped truth of the left camera (TUM, *.truth.csv); without it the drive's own")
      ->check(existing_file());
  sub->add_option("--first", options->frames.first, "Number of the first frame")
      ->check(whole_number());
  sub->add_option("--last", options->frames.last, "Number of the last frame")
      ->check(whole_number());
  sub->add_option("--html", options->html, "Write a page with table and pictures to this file")
      ->check(writable_file());
  sub->callback(
      [options, &command] { command = [options] { return compare_odometry(*options); }; });
}

}  // namespace maploop::tools
