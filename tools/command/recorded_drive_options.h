// Which recorded drives an experiment on map matching takes, and with which parameters.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace maploop::tools {

struct RecordedDriveOptions {
  std::filesystem::path map, data;
  std::vector<std::string> sequences{"00", "01", "02", "03", "04", "06", "08", "10"};
  std::vector<std::string> set;
  int seeds = 3;
};

// `map` says which files MAP may be.
void add_recorded_drive_options(CLI::App& command, RecordedDriveOptions& options, const char* map);

}  // namespace maploop::tools
