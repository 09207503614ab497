// maploop send: a recorded drive as live traffic.
#include "tools/command/commands.h"
#include "tools/command/option_checks.h"
#include "tools/command/options.h"
#include "tools/send/send_run.h"

namespace maploop::tools {

void add_send(CLI::App& app, Command& command) {
  const auto [sub, options] = add_command(
      app, command, "send",
      "Send a KITTI raw drive as its sensors would: the LiDAR as packets of an HDL-64E, the IMU as "
      "NCOM, fixes as NMEA, images through a pipeline, in real time, for maploop live. Endpoints "
      "are udp://[ADDRESS]:PORT, "
      "without an address on this host",
      send);
  sub->add_option("DRIVE", options.drive, "Folder such as 2011_09_26/2011_09_26_drive_0013_sync")
      ->required();
  sub->add_option("--camera", options.camera,
                  "GStreamer elements that take the pairs, side by side in one grey image: "
                  "'rtpgstpay ! udpsink host=127.0.0.1 port=5004'");
  sub->add_option("--velodyne", options.velodyne, "Where its data packets go");
  sub->add_option("--imu", options.imu, "Where NCOM goes");
  sub->add_option("--gnss", options.gnss, "Where NMEA goes");
  sub->add_option("--calibration", options.calibration,
                  "Write the scanner's calibration (db.xml) to this file; alone: and end");
  sub->add_option("--truth", options.truth,
                  "Write the reference, with the stamps that it is sent with, to this file (TUM, "
                  "left camera, every millisecond)");
  sub->add_option("--seconds", options.seconds, "End so far into the drive")
      ->check(positive_number());
  add_config(sub, options.config, "TOML file of parameters: noise of the fixes");
}

}  // namespace maploop::tools
