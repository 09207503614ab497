// maploop calibrate extrinsics: where the sensors of a recorded drive are, and how late.

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "tools/calibrate/extrinsics/extrinsics.h"
#include "tools/calibrate/extrinsics/extrinsics_text.h"
#include "tools/command/commands.h"
#include "tools/command/json_output.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/command/progress.h"
#include "tools/evaluate/text_file.h"

namespace maploop::tools {
namespace {

struct ExtrinsicsOptions {
  std::filesystem::path recording, config, toml = "calibrated.toml", json;
  std::vector<std::string> topics;
  double start = 0.0, end = 0.0;  // s; end 0: that of the recording
};

// Whatever is described of the unit's mount is looked for again.
void forget_mount(vehicle::VehicleConfig& config) {
  for (const char* key : {"roll", "pitch", "yaw"})
    config.given.erase(std::string("vehicle.imu.") + key);
}

extrinsics::Measurements measured_with_progress(const vehicle::Recording& recording,
                                                const vehicle::VehicleConfig& config,
                                                const extrinsics::Stretch& stretch) {
  Progress progress("s of data");
  const Time first = recording.first_stamp;
  return extrinsics::measure(recording, config, stretch, [&](Time t) {
    progress.at(to_seconds(t - first), to_seconds(recording.last_stamp - first));
  });
}

int calibrate_extrinsics(const ExtrinsicsOptions& options) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(options.config, {}, options.topics);
  config.ppp.observations = false;  // they say nothing of where the sensors are
  forget_mount(config);
  const vehicle::KnownContents contents = vehicle::fit_to_recording(config, options.recording);
  const vehicle::Recording recording = vehicle::open_recording(options.recording, config, contents);
  for (const std::string& note : recording.notes) std::cerr << "maploop: " << note << '\n';
  vehicle::describe_car(config, recording.calibration);
  extrinsics::Stretch stretch;
  if (options.start > 0.0) stretch.from = recording.first_stamp + from_seconds(options.start);
  if (options.end > 0.0) stretch.to = recording.first_stamp + from_seconds(options.end);
  const auto measured = measured_with_progress(recording, config, stretch);
  const extrinsics::Extrinsics found = extrinsics::find_extrinsics(measured, config.vehicle);
  if (found.pairs.empty() && !measured.inertial.mount) {
    throw std::runtime_error(
        "'" + options.recording.string() +
        "' has no two sensors to compare: that needs two of a pair of cameras, a LiDAR and an "
        "inertial unit, or the unit and the fixes of a GNSS receiver; 'maploop doctor' says what "
        "there is");
  }
  std::cout << to_text(found);
  evaluation::write_text(options.toml, to_toml(found, options.recording.string()));
  std::cout << "\nwritten: " << options.toml.string() << "; --config " << options.toml.string()
            << " uses it\n";
  if (!options.json.empty()) write_json_file(options.json, to_json(found));
  return 0;
}

}  // namespace

void add_calibrate_extrinsics(CLI::App& calibrate, Command& command) {
  const auto [sub, options] = add_command(
      calibrate, command, "extrinsics",
      "Find how cameras, LiDAR and inertial unit of a recorded drive are turned against each "
      "other, how late their stamps are, and where they are as far as the drive shows it, each "
      "with its standard deviation",
      calibrate_extrinsics);
  sub->add_option("RECORDING", options.recording,
                  "Whatever maploop replay takes: some minutes of driving with turns")
      ->required()
      ->check(existing_path());
  add_config(sub, options.config,
             "TOML file that describes the vehicle, to 10 deg and 0.3 s; the search begins there");
  add_topics(sub, options.topics);
  sub->add_option("--start", options.start, "Begin so many seconds into the recording")
      ->check(number_from_zero());
  sub->add_option("--end", options.end, "End so many seconds into the recording")
      ->check(positive_number());
  sub->add_option("--toml", options.toml, "Write the description of the vehicle to this file")
      ->capture_default_str()
      ->check(writable_file());
  add_output(sub, "--json", options.json, "Write all figures to this file as JSON");
}

}  // namespace maploop::tools
