// This file reports how much memory a vehicle's threads and rings hold at most, as text and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/graph/memory_budget.h"

namespace maploop::tools {

struct MemoryReport {
  vehicle::SampleSizes sizes;
  std::vector<vehicle::MemoryPart> parts;
  int mapped_mb = 0;  // of the heap, at the start

  double megabytes() const;
};

// The images are those of the described camera, else KITTI's; the scans are the largest of a
// scanner with 64 lasers at 10 Hz.
MemoryReport memory_report(const vehicle::VehicleConfig& config);

// Parts below 0.5 MB are one line together.
std::string to_text(const MemoryReport& report);
nlohmann::json to_json(const MemoryReport& report);

}  // namespace maploop::tools
