// maploop experiment ppp-map: the map inside the PPP filter.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/command/option_checks.h"
#include "tools/evaluate/text_file.h"
#include "tools/experiment/experiments.h"
#include "tools/experiment/ppp_map_experiment.h"

namespace maploop::tools {
namespace {

struct PppMapCommand {
  std::filesystem::path folder, map, truth, labels, config, html;
  std::vector<std::filesystem::path> simulated, products;
  std::string systems;
  experiments::PppMapOptions options;
};

// urban_3 is of the group urban.
std::string group_of(const std::string& name) {
  const auto end = name.find_last_not_of("0123456789");
  if (end == std::string::npos || end + 1 == name.size()) return name;
  return name.substr(0, name[end] == '_' || name[end] == '-' ? end : end + 1);
}

std::vector<experiments::PppDriveFiles> drives_of(const PppMapCommand& command) {
  std::vector<experiments::PppDriveFiles> drives;
  if (!command.folder.empty()) {
    if (command.map.empty() || command.truth.empty())
      throw std::runtime_error("a recorded drive needs --map and --truth");
    const std::string name = std::filesystem::weakly_canonical(command.folder).filename().string();
    drives.push_back(
        {name, name, command.folder, command.truth, command.map, command.labels, command.products});
  }
  for (const std::filesystem::path& drive : command.simulated) {
    const std::string name = std::filesystem::weakly_canonical(drive).filename().string();
    for (const char* receiver : {"gnss", "gnss_one_frequency"}) {
      const std::filesystem::path folder = drive / "town_sync" / receiver;
      const bool two = std::string(receiver) == "gnss";
      drives.push_back({name,
                        group_of(name) + (two ? ", two frequencies" : ", one frequency"),
                        folder,
                        folder / "truth.csv",
                        drive / "map.osm",
                        {},
                        {}});
    }
  }
  return drives;
}

int compare(const PppMapCommand& command) {
  experiments::PppMapOptions options = command.options;
  const vehicle::VehicleConfig config = vehicle::load_vehicle_config(command.config);
  options.setup.parameters = config.ppp.filter;
  if (!command.systems.empty()) options.setup.parameters.systems = command.systems;
  options.match = config.mapmatch;
  options.feedback = config.feedback;
  std::vector<experiments::PppDrive> drives;
  for (const auto& files : drives_of(command)) drives.push_back(experiments::read_ppp_drive(files));
  const mapmatch::RuleBases rules = mapmatch::read_rule_bases(mapmatch::default_rules());
  const auto results = experiments::compare_ppp_map(
      drives, rules, options,
      [](const std::string& what) { std::cerr << '\r' << what << "\033[K" << std::flush; });
  std::cerr << "\r\033[K";
  std::cout << to_text(results, options);
  if (!command.html.empty()) evaluation::write_text(command.html, to_html(results, options));
  return 0;
}

}  // namespace

void add_ppp_map_experiment(CLI::App& experiment, Command& command) {
  auto options = std::make_shared<PppMapCommand>();
  CLI::App* sub = experiment.add_subcommand(
      "ppp-map",
      "PPP with the map fed back and without: whole drives on right and wrong maps, cold starts, "
      "starts anew behind made tunnels, few satellites");
  sub->add_option("FOLDER", options->folder,
                  "A receiver's observations and the products for them, of a recorded drive")
      ->check(existing_folder());
  sub->add_option("--products", options->products,
                  "More of them: files or folders, such as a navigation file of a day near to it")
      ->check(existing_path());
  sub->add_option("--map", options->map, "Its OpenStreetMap file")->check(existing_file());
  sub->add_option("--truth", options->truth, "Where it was, as maploop ppp takes it")
      ->check(existing_file());
  sub->add_option("--labels", options->labels,
                  "CSV gps_tow,on_map,way_id: what of the map it drove on; then on wrong maps, too")
      ->check(existing_file());
  sub->add_option("--simulated", options->simulated,
                  "Drives of `maploop simulate`; those whose names differ in a number at the end "
                  "alone are pooled")
      ->delimiter(',')
      ->check(existing_folder());
  sub->add_option("--systems", options->systems, "As of maploop ppp");
  sub->add_option("--starts", options->options.starts, "Parts of each drive and case")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub->add_option("--length", options->options.length, "Seconds of a part")
      ->check(number_in(10.0, 3600.0))
      ->capture_default_str();
  sub->add_option("--tunnel", options->options.tunnel, "Seconds without satellites")
      ->check(number_in(1.0, 600.0))
      ->capture_default_str();
  sub->add_option("--few", options->options.few, "Degrees: few satellites are those above")
      ->check(number_in(1.0, 80.0))
      ->capture_default_str();
  sub->add_option("--config", options->config,
                  "TOML file whose [ppp], [mapmatch] and [feedback] are taken")
      ->check(existing_file());
  sub->add_option("--html", options->html, "Write a page with tables and pictures to this file")
      ->check(writable_file());
  sub->callback([options, &command] {
    if (options->folder.empty() && options->simulated.empty())
      throw CLI::RequiredError("FOLDER with GNSS files, or --simulated,");
    command = [options] { return compare(*options); };
  });
}

}  // namespace maploop::tools
