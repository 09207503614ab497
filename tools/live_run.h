// One drive with live sensors: what it was asked for, and how it runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "runtime/vehicle/vehicle_config.h"
#include "tools/run_pass.h"

namespace maploop::tools {

struct LiveOptions {
  std::filesystem::path config;
  double seconds = 0.0;  // 0: until it is stopped
  bool no_lcm = false;
  std::string lcm_url;   // empty: as vehicle::bus_url() says
  bool verbose = false;  // every real-time setting, not only what was not granted
  std::filesystem::path record;
  bool record_raw = false;
  std::filesystem::path map;
  std::optional<vehicle::MapMode> map_mode;
  std::filesystem::path json, report, trace;
  StateFiles states;
};

// Runs until SIGINT or SIGTERM, or for so long; then prints the verdict and writes the files
// asked for. Returns the command's exit status: 1 when a thread failed, no sensor delivered
// anything, or the log does not hold everything. Throws std::runtime_error naming the file or the
// key that is wrong, before it starts.
int live(const LiveOptions& options);

}  // namespace maploop::tools
