// maploop simulate: a drive through a generated town.
#include "tools/simulate/simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "msgs/frames.h"
#include "msgs/time.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/command/terminal.h"

namespace maploop::tools {
namespace {

struct SimulateOptions {
  std::filesystem::path out;
  simulate::SimulationOptions drive;
};

// "49.01,8.43"
Geodetic parse_place(const std::string& text) {
  double latitude = 0.0, longitude = 0.0;
  char comma = 0, more = 0;
  std::istringstream in(text);
  if (!(in >> latitude >> comma >> longitude) || comma != ',' || in >> more ||
      !(std::fabs(latitude) <= 85.0 && std::fabs(longitude) <= 180.0))
    throw CLI::ValidationError("--route", "'" + text + "' is no LATITUDE,LONGITUDE in degrees");
  return {radians(latitude), radians(longitude), 0.0};
}

// Adds an option that takes one of the names of an enumeration.
template <NamedEnum Enum>
void add_choice(CLI::App* sub, const char* flag, Enum& value, const char* what) {
  sub->add_option_function<std::string>(
         flag, [&value](const std::string& name) { value = *value_named<Enum>(name); }, what)
      ->check(CLI::IsMember(choices<Enum>()))
      ->default_str(std::string(to_string(value)));
}

int simulate_command(const SimulateOptions& options) {
  note_interrupts();
  Progress progress("frames");
  const bool complete =
      simulate::simulate_drive(options.out, options.drive, [&](std::size_t done, std::size_t all) {
        progress.at(static_cast<double>(done), static_cast<double>(all));
        return !interrupted();
      });
  if (!complete) {
    std::cerr << "broken off; nothing is left of it\n";
    return 130;
  }
  const auto drive = options.out / "town_extract", config = options.out / "vehicle.toml";
  std::cout << "wrote " << options.out.string();
  const simulate::SimulatedSensors& made = options.drive.sensors;
  if (made.camera && made.imu) {
    std::cout << "; to see it:\n  maploop replay " << drive.string() << " --config "
              << config.string();
  }
  std::cout << '\n';
  return 0;
}

}  // namespace

void add_simulate(CLI::App& app, Command& command) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* sub = app.add_subcommand("simulate",
                                     "Make a drive through a generated town or on a map's roads: "
                                     "cameras, LiDAR, IMU, GNSS, map and "
                                     "truth");
  sub->add_option("--out", options->out,
                  "New folder for the drive, in KITTI's layout (24 MB a second; --compact)")
      ->required();
  sub->add_option("--seconds", options->drive.seconds, "How long the drive takes")
      ->check(number_in(1.0, simulate::most_seconds))
      ->capture_default_str();
  sub->add_option("--seed", options->drive.seed, "Another seed, another town and drive")
      ->capture_default_str();
  CLI::Option* map =
      sub->add_option("--map", options->drive.map,
                      "OpenStreetMap file: along its roads instead of through a generated town")
          ->check(existing_file());
  sub->add_option_function<std::vector<std::string>>(
         "--route",
         [options](const std::vector<std::string>& places) {
           for (const std::string& place : places)
             options->drive.route.push_back(parse_place(place));
         },
         "LATITUDE,LONGITUDE ...: the shortest way by these places of the map, and on as the seed "
         "will")
      ->needs(map);
  add_choice(sub, "--imu-grade", options->drive.imu, "tactical or mems");
  add_choice(sub, "--environment", options->drive.environment,
             "What stands along the streets: town, open, suburban or urban");
  sub->add_option_function<std::vector<std::string>>(
         "--sensors",
         [options](const std::vector<std::string>& names) {
           const auto has = [&names](const char* name) {
             return std::find(names.begin(), names.end(), name) != names.end();
           };
           options->drive.sensors = {has("camera"), has("lidar"), has("imu"), has("gnss")};
         },
         "Those of the drive, of camera,lidar,imu,gnss; the first two are what takes time")
      ->delimiter(',')
      ->check(CLI::IsMember({"camera", "lidar", "imu", "gnss"}))
      ->default_str("camera,lidar,imu,gnss");
  add_choice(sub, "--scanner", options->drive.scanner, "hdl-64e or vlp-16");
  add_choice(sub, "--car", options->drive.car,
             "standard: KITTI's mounting; drawn: sensors elsewhere, turned and late, by the seed, "
             "and vehicle_rough.toml, which describes them roughly");
  sub->add_option_function<std::string>(
         "--scanner-clock",
         [options](const std::string& name) { options->drive.free_scanner = name == "free"; },
         "free: the scanner turns beside the cameras with a phase and a drift; camera: each image "
         "is taken in the middle of a turn, as on KITTI's car")
      ->check(CLI::IsMember({"free", "camera"}))
      ->default_str("free");
  sub->add_flag("--compact", options->drive.compact,
                "Scans as the scanner's ranges, images of 86 grey levels: 5 MB a second");
  sub->add_option("--gnss-rate", options->drive.gnss_rate, "Epochs of the GNSS receiver; Hz")
      ->check(number_in(0.1, 20.0))
      ->capture_default_str();
  sub->add_flag(
      "--heights", options->drive.heights,
      "The height of the ground too, as SRTM would have it: a tile for maploop ppp --heights");
  sub->callback(
      [options, &command] { command = [options] { return simulate_command(*options); }; });
}

}  // namespace maploop::tools
