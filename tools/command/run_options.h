// What every run of the vehicle can be asked for, live or recorded.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/replay/run_pass.h"

namespace maploop::tools {

struct RunOptions {
  std::filesystem::path config;
  bool verbose = false;  // the tables at the end, and every real-time setting
  std::filesystem::path record;
  bool record_raw = false;
  bool no_lcm = false;
  std::string lcm_url;  // empty: as vehicle::bus_url() says
  std::filesystem::path json, report, trace;
  StateFiles states;
  std::filesystem::path map;
  std::optional<vehicle::MapMode> map_mode;
};

// All of them but the configuration.
void add_run_options(CLI::App* sub, RunOptions& options);

}  // namespace maploop::tools
