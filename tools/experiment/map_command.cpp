// maploop experiment map: the map in the loop.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>

#include "mapmatch/osm_reader.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/evaluate/text_file.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/map_experiment.h"

namespace maploop::tools {
namespace {

struct MapOptions {
  std::filesystem::path map, folder, config, html, csv;
  experiments::MapCases cases;
  std::vector<std::string> settings;
  bool faults = false;
};

// Every tick of every run.
std::string samples_csv(const std::vector<experiments::MapResult>& results) {
  std::string text =
      "sequence,configuration,unit,no_gnss,fault,mode,seed,t,truth_e,truth_n,error_e,error_n,"
      "azimuth_error,sigma,nees,p_link,feedback\n";
  for (const experiments::MapResult& r : results) {
    const experiments::MapCase& c = r.setup;
    for (const experiments::MapSample& s : r.samples) {
      text += fmt::format(
          "{},{},{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{}"
          "\n",
          c.sequence, c.configuration, c.unit(), c.outages, c.fault, to_string(c.mode), c.seed,
          s.time, s.truth.x(), s.truth.y(), s.error.x(), s.error.y(), s.azimuth_error, s.sigma,
          s.nees, s.probability, to_string(s.reason));
    }
  }
  return text;
}

int compare_modes(const MapOptions& options) {
  experiments::MapSetting setting;
  setting.config = vehicle::load_vehicle_config(options.config, options.settings);
  setting.folder = options.folder;
  mapmatch::MapExtract map;
  if (options.faults) map = mapmatch::read_osm(options.map);
  setting.extract = &map;
  setting.config.map = {options.map, vehicle::MapMode::loose, setting.config.map.rules};
  setting.roads = vehicle::load_road_map(setting.config.map);
  experiments::MapCases wanted = options.cases;
  wanted.poses = !setting.config.odometry_poses.file.empty();
  if (options.faults) wanted.faults = experiments::map_faults();
  const auto cases = experiments::map_cases(wanted);
  const auto results = experiments::run_all(
      cases,
      [](const experiments::MapCase& c) {
        return "sequence " + c.sequence + ", " + std::string(to_string(c.mode));
      },
      [&](const experiments::MapCase& c) { return run(setting, c); });
  std::cout << experiments::to_text(results);
  if (!options.html.empty())
    evaluation::write_text(options.html, experiments::to_html(setting, results));
  if (!options.csv.empty()) evaluation::write_text(options.csv, samples_csv(results));
  return 0;
}

}  // namespace

void add_map_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<MapOptions>();
  CLI::App* sub = experiment.add_subcommand(
      "map",
      "The map in the loop on KITTI's odometry sequences: dead reckoning behind some seconds of "
      "GNSS, without the map, loose, tight and with hard resets; on wrong maps, too");
  sub->add_option("MAP", options->map, "OpenStreetMap file; without --faults also a network file")
      ->required()
      ->check(existing_file());
  sub->add_option("FOLDER", options->folder, "Folder kitti_odometry, with oxts and labels")
      ->required()
      ->check(existing_folder());
  experiments::MapCases& cases = options->cases;
  sub->add_option("--sequences", cases.sequences, "Which of them")
      ->delimiter(',')
      ->capture_default_str();
  add_choices(sub, "--modes", cases.modes, "Which of none, loose, tight, hard-reset");
  sub->add_option("--units", cases.units, "Inertial units: mems, recorded")
      ->delimiter(',')
      ->check(CLI::IsMember({"mems", "recorded"}))
      ->capture_default_str();
  sub->add_option("--configurations", cases.configurations,
                  "Of the filter; those with odometry on the sequences that have tracks")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--gnss-outage", cases.outages,
                  "START:LENGTH, each a run of its own; LENGTH `end`: to the end")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--speed-scale", cases.speed_scale, "What the wheels read, of the true speed")
      ->check(CLI::Range(0.5, 1.5))
      ->capture_default_str();
  sub->add_option("--seeds", cases.seeds, "Realizations of what is random")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  sub->add_flag("--faults", options->faults, "On wrong maps, too");
  sub->add_option("--config", options->config, "TOML file of the other parameters")
      ->check(existing_file());
  add_settings(sub, options->settings);
  sub->add_option("--html", options->html, "Write a page with tables and pictures to this file");
  sub->add_option("--csv", options->csv, "Write every tick of every run to this file");
  sub->callback([options, &command] { command = [options] { return compare_modes(*options); }; });
}

}  // namespace maploop::tools
