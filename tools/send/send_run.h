// A recorded drive as the traffic of live sensors.
#pragma once

#include <filesystem>
#include <string>

namespace maploop::tools {

struct SendOptions {
  std::filesystem::path drive;
  std::filesystem::path config;
  std::string camera;                 // elements of a GStreamer pipeline; empty: not sent
  std::string velodyne, imu, gnss;    // endpoints, udp; empty: not sent
  std::filesystem::path calibration;  // of the scanner, written; empty: not
  std::filesystem::path truth;        // TUM, written; empty: not
  double seconds = 0.0;               // of the drive; 0: all of it
};

// Begins a second after the start, and sends each sample when it would have been delivered, until
// the end of the drive, SIGINT or SIGTERM. Throws std::runtime_error naming what is wrong with the
// drive, an endpoint or a file.
int send(const SendOptions& options);

}  // namespace maploop::tools
