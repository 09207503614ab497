// What a capture of a Velodyne scanner holds.
#pragma once

#include <filesystem>

#include "sensors/velodyne/capture_source.h"

namespace maploop::tools {

struct CaptureInfoOptions {
  std::filesystem::path file;
  sensors::VelodyneCaptureOptions capture;
  std::filesystem::path scans;  // folder; empty: none are written
  std::filesystem::path json;   // empty: none
};

// Prints it; the exit status.
int show_capture(const CaptureInfoOptions& options);

}  // namespace maploop::tools
