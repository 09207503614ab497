// maploop sensors: look at what sensors send.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "tools/command/choice_option.h"
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/sensors/sensors_listen.h"
#include "tools/sensors/velodyne_capture_info.h"

namespace maploop::tools {

namespace {

const std::vector<std::string> models{"HDL-64E", "HDL-32E", "VLP-16"};

void add_listen(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand(
      "listen",
      "Listen to live sensors for a while, and say what comes. An endpoint is udp://[ADDRESS]:PORT "
      "(without an address: of this host alone), tcp://ADDRESS:PORT or "
      "serial:///dev/NAME?baud=115200");
  const auto options = std::make_shared<ListenOptions>();
  sub->add_option("--velodyne", options->velodyne, "Endpoint of its data packets");
  sub->add_option("--velodyne-position", options->velodyne_position,
                  "Endpoint of its position packets");
  sub->add_option("--model", options->model, "Scanner")->check(CLI::IsMember(models));
  sub->add_option("--calibration", options->calibration,
                  "The scanner's calibration file (db.xml); an HDL-64E needs it")
      ->check(existing_file());
  sub->add_option("--imu", options->imu, "Endpoint of an OXTS unit's NCOM");
  sub->add_option("--gnss", options->gnss, "Endpoint of a receiver");
  add_choice(sub, "--gnss-protocol", options->gnss_protocol,
             "nmea, ubx: its fixes; observations: UBX or RTCM 3; default: nmea");
  sub->add_option("--seconds", options->seconds, "How long")->check(number_in(0.1, 86400.0));
  sub->add_option("--json", options->json, "Write what was heard to this file as JSON")
      ->check(writable_file());
  sub->callback(
      [options, &command] { command = [options] { return listen_to_sensors(*options); }; });
}

void add_pcap(CLI::App& app, Command& command) {
  CLI::App* pcap = app.add_subcommand(
      "pcap", "Decode a capture (pcap, pcapng, plain or .gz) of a Velodyne scanner's packets");
  const auto options = std::make_shared<CaptureInfoOptions>();
  const auto model = std::make_shared<std::string>();
  pcap->add_option("FILE", options->file, "Capture")->required()->check(existing_file());
  pcap->add_option("--model", *model, "Scanner; else as its packets say")
      ->check(CLI::IsMember(models));
  pcap->add_option("--calibration", options->capture.calibration,
                   "The scanner's calibration file (db.xml); an HDL-64E needs it")
      ->check(existing_file());
  pcap->add_option("--scans", options->scans,
                   "Write each turn to this folder, as KITTI's: 0000000000.bin with x, y, z, "
                   "reflectance as float32");
  pcap->add_option("--json", options->json, "Write what was found to this file as JSON")
      ->check(writable_file());
  pcap->callback([options, model, &command] {
    options->capture.model = sensors::velodyne_model(*model);
    command = [options] { return show_capture(*options); };
  });
}

}  // namespace

void add_sensors(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand("sensors", "Look at what sensors send");
  const auto options = std::make_shared<ListenOptions>();
  sub->add_option("CONFIG", options->config,
                  "Listen for a while to the sensors that [live] of this TOML file names, as "
                  "maploop live would, and say of each what it is")
      ->check(existing_file());
  sub->add_option("--seconds", options->seconds, "How long")->check(CLI::Range(0.1, 86400.0));
  sub->add_option("--json", options->json, "Write what was heard to this file as JSON");
  sub->require_subcommand(0, 1);
  add_pcap(*sub, command);
  add_listen(*sub, command);
  sub->callback([sub, options, &command] {
    if (!sub->get_subcommands().empty()) return;
    if (options->config.empty()) throw CLI::RequiredError("CONFIG, or one of listen and pcap,");
    command = [options] { return listen_to_sensors(*options); };
  });
}

}  // namespace maploop::tools
