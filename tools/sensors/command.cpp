// maploop sensors: look at what sensors send.
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/sensors/sensors.h"

namespace maploop::tools {
namespace {

// Options of a Velodyne scanner; `calibration` is the name of a file.
void add_scanner(CLI::App* sub, std::string& model, auto& calibration, const char* what) {
  sub->add_option("--model", model, what)->check(CLI::IsMember({"HDL-64E", "HDL-32E", "VLP-16"}));
  sub->add_option("--calibration", calibration,
                  "The scanner's calibration file (db.xml); an HDL-64E needs it")
      ->check(existing_file());
}

void add_listen(CLI::App& app, Command& command) {
  const auto [sub, options] = add_command(
      app, command, "listen",
      "Listen to live sensors for a while, and say what comes. An endpoint is udp://[ADDRESS]:PORT "
      "(without an address: of this host alone), tcp://ADDRESS:PORT or "
      "serial:///dev/NAME?baud=115200",
      listen_to_sensors);
  vehicle::LiveParameters& live = options.live;
  sub->add_option("--velodyne", live.velodyne, "Endpoint of its data packets");
  sub->add_option("--velodyne-position", live.velodyne_position,
                  "Endpoint of its position packets");
  add_scanner(sub, options.lidar.model, options.lidar.calibration, "Scanner");
  sub->add_option("--imu", live.imu, "Endpoint of an OXTS unit's NCOM");
  sub->add_option("--gnss", live.gnss, "Endpoint of a receiver");
  add_choice(sub, "--gnss-protocol", options.gnss_protocol,
             "nmea, ubx: its fixes; observations: UBX or RTCM 3; default: nmea");
  sub->add_option("--seconds", options.seconds, "How long")->check(number_in(0.1, 86400.0));
  add_output(sub, "--json", options.json, "Write what was heard to this file as JSON");
}

void add_pcap(CLI::App& app, Command& command) {
  const auto [sub, options] =
      add_command(app, command, "pcap",
                  "Decode a capture (pcap, pcapng, plain or .gz) of a Velodyne scanner's packets",
                  show_capture);
  sub->add_option("FILE", options.file, "Capture")->required()->check(existing_file());
  add_scanner(sub, options.model, options.calibration, "Scanner; else as its packets say");
  sub->add_option("--scans", options.scans,
                  "Write each turn to this folder, as KITTI's: 0000000000.bin with x, y, z, "
                  "reflectance as float32");
  add_output(sub, "--json", options.json, "Write what was found to this file as JSON");
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
