// What `maploop sensors` shows.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "msgs/vehicle_description.h"
#include "runtime/vehicle/config/live_config.h"

namespace maploop::tools {

struct ListenOptions {
  std::filesystem::path config;  // its [live] names the endpoints; empty: `live` does
  vehicle::LiveParameters live;
  LidarDescription lidar;
  std::optional<vehicle::GnssProtocol> gnss_protocol;
  double seconds = 5.0;
  std::filesystem::path json;  // empty: none
};

// Listens for a while, or until SIGINT or SIGTERM, and prints a block for each sensor. Returns 0 if
// each of them delivered something, else 1.
int listen_to_sensors(const ListenOptions& options);

struct CaptureOptions {
  std::filesystem::path file;
  std::string model;                  // empty: as its packets say
  std::filesystem::path calibration;  // empty: the model's own
  std::filesystem::path scans;        // folder; empty: none are written
  std::filesystem::path json;         // empty: none
};

// Prints the contents of a capture of a Velodyne scanner, and returns the exit status.
int show_capture(const CaptureOptions& options);

}  // namespace maploop::tools
