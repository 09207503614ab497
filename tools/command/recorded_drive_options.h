// The options of experiments on map matching: those of the matcher, and which recorded drives.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/command/matcher_options.h"

namespace maploop::tools {

struct RecordedDriveOptions : MatcherOptions {
  std::filesystem::path data;
  std::vector<std::string> sequences{"00", "01", "02", "03", "04", "06", "08", "10"};
  int seeds = 3;
};

// `map` says which files MAP may be.
void add_recorded_drive_options(CLI::App& command, RecordedDriveOptions& options, const char* map);

}  // namespace maploop::tools
