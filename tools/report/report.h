// Writes the results of one replay as a page.
#pragma once

#include <filesystem>
#include <vector>

#include "mapmatch/road_network.h"
#include "msgs/reference.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "tools/replay/replay_result.h"
#include "tools/replay/run_pass.h"

namespace maploop::report {

struct ReplayReport {
  const tools::ReplayResult& result;
  const tools::RunPass& pass;
  std::vector<ReferencePose> reference;  // empty if the recording has none
  const vehicle::VehicleConfig& config;
  const mapmatch::RoadNetwork* roads = nullptr;  // nullptr if there was no map
};

// Writes one HTML page. Throws std::runtime_error naming the file if it cannot be written.
void write_report(const std::filesystem::path& file, const ReplayReport& report);

}  // namespace maploop::report
