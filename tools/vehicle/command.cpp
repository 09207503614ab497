// This is maploop vehicle, which asks for, checks, draws and converts the description of a vehicle.
#include <functional>
#include <iostream>
#include <stdexcept>

#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/evaluate/text_file.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::tools {
namespace {

namespace fs = std::filesystem;

struct VehicleOptions {
  std::string kind;
  fs::path input, out = "vehicle.toml";
};

void refuse_to_overwrite(const fs::path& file) {
  std::error_code ignored;
  if (fs::exists(file, ignored))
    throw std::runtime_error("'" + file.string() +
                             "' exists already: name another file, or remove it");
}

void wrote(const fs::path& file) {
  std::cout << "wrote " << file.string() << "; 'maploop vehicle check " << file.string()
            << "' says what is missing, --config " << file.string() << " uses it\n";
}

int ask_for_vehicle(const VehicleOptions& options) {
  refuse_to_overwrite(options.out);
  const std::string text = to_toml(vehicle_tool::ask(std::cin, std::cout));
  evaluation::write_text(options.out, "# What is known of a vehicle.\n" + text);
  std::cout << '\n';
  wrote(options.out);
  return 0;
}

int check_vehicle(const VehicleOptions& options) {
  const vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.input);
  const vehicle_tool::Findings found = vehicle_tool::look_at(config);
  for (const std::string& warning : found.warnings) std::cout << "warning: " << warning << '\n';
  if (!found.assumed.empty()) std::cout << "not given, and therefore assumed:\n";
  for (const std::string& line : found.assumed) std::cout << "  " << line << '\n';
  std::cout << options.input.string() << " can be used\n";
  return 0;
}

int draw_vehicle(const VehicleOptions& options) {
  evaluation::write_text(options.out,
                         vehicle_tool::drawing(vehicle::load_vehicle_config(options.input)));
  std::cout << "wrote " << options.out.string() << '\n';
  return 0;
}

int convert_vehicle(const VehicleOptions& options) {
  refuse_to_overwrite(options.out);
  vehicle_tool::Converted converted =
      options.kind == "kitti"   ? vehicle_tool::from_kitti(options.input)
      : options.kind == "euroc" ? vehicle_tool::from_euroc(options.input)
                                : vehicle_tool::from_kitti_360(options.input);
  if (converted.cameras) {
    fs::path cameras = options.out;
    cameras.replace_extension("cameras.toml");
    refuse_to_overwrite(cameras);
    evaluation::write_text(cameras, vehicle::to_toml(*converted.cameras));
    converted.description.camera.calibration = cameras.filename().string();
    std::cout << "wrote " << cameras.string() << '\n';
  }
  evaluation::write_text(options.out, "# Converted from the calibration of " + options.kind + ". " +
                                          converted.note + '\n' + to_toml(converted.description));
  wrote(options.out);
  return 0;
}

CLI::Option* add_file(CLI::App* sub, VehicleOptions& options) {
  return sub->add_option("FILE", options.input, "Description, or a whole configuration")
      ->required()
      ->check(existing_file());
}

}  // namespace

void add_vehicle(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand(
      "vehicle",
      "Describe a car in one file: sensors, axle, wheels, each with its standard deviation");
  sub->require_subcommand(1);
  const auto [ask, asked] =
      add_command(*sub, command, "new", "Ask for every value, and write the file", ask_for_vehicle);
  ask->add_option("FILE", asked.out, "New file")->capture_default_str()->check(writable_file());
  const auto [check, checked] =
      add_command(*sub, command, "check", "Say what is wrong, implausible or not given in a file",
                  check_vehicle);
  add_file(check, checked);
  const auto [draw, drawn] =
      add_command(*sub, command, "draw", "Draw a file from above and from the side", draw_vehicle);
  add_file(draw, drawn);
  draw->add_option("SVG", drawn.out, "Picture to be written")->required()->check(writable_file());
  const auto [convert, given] = add_command(
      *sub, command, "convert", "Make a file from the calibration of a dataset", convert_vehicle);
  convert->add_option("KIND", given.kind, "kitti, kitti-360 or euroc")
      ->required()
      ->check(CLI::IsMember({"kitti", "kitti-360", "euroc"}));
  convert->add_option("INPUT", given.input, "Folder of the calibration, or of a drive")
      ->required()
      ->check(existing_folder());
  convert->add_option("OUT", given.out, "New file")->required()->check(writable_file());
}

}  // namespace maploop::tools
