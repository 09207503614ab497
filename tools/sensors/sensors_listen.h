// Listening to live sensors for a while, and saying what was heard.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runtime/vehicle/config/live_config.h"

namespace maploop::tools {

struct ListenOptions {
  std::filesystem::path config;  // its [live] says what to listen to; empty: the endpoints do
  std::string velodyne, velodyne_position, imu, gnss;  // endpoints; empty: not listened to
  std::optional<vehicle::GnssProtocol> gnss_protocol;
  std::string model = "VLP-16";
  std::filesystem::path calibration;
  double seconds = 5.0;
  std::filesystem::path json;  // empty: none
};

// Prints a block a sensor; 0 where each of them was heard. Ends early at SIGINT or SIGTERM.
int listen_to_sensors(const ListenOptions& options);

}  // namespace maploop::tools
