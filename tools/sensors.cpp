// maploop sensors: look at what sensors send.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "tools/commands.h"
#include "tools/velodyne_capture_info.h"

namespace maploop::tools {

void add_sensors(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand("sensors", "Look at what sensors send");
  sub->require_subcommand(1);
  CLI::App* pcap = sub->add_subcommand(
      "pcap", "Decode a capture (pcap, pcapng, plain or .gz) of a Velodyne scanner's packets");
  const auto options = std::make_shared<CaptureInfoOptions>();
  const auto model = std::make_shared<std::string>();
  pcap->add_option("FILE", options->file, "Capture")->required()->check(CLI::ExistingFile);
  pcap->add_option("--model", *model, "Scanner; else as its packets say")
      ->check(CLI::IsMember({"HDL-64E", "HDL-32E", "VLP-16"}));
  pcap->add_option("--calibration", options->capture.calibration,
                   "The scanner's calibration file (db.xml); an HDL-64E needs it")
      ->check(CLI::ExistingFile);
  pcap->add_option("--scans", options->scans,
                   "Write each turn to this folder, as KITTI's: 0000000000.bin with x, y, z, "
                   "reflectance as float32");
  pcap->add_option("--json", options->json, "Write what was found to this file as JSON");
  pcap->callback([options, model, &command] {
    options->capture.model = sensors::velodyne_model(*model);
    command = [options] { return show_capture(*options); };
  });
}

}  // namespace maploop::tools
