// What --map and --map-mode change in a configuration.
#pragma once

#include <filesystem>
#include <optional>

#include "runtime/vehicle/config/vehicle_config.h"

namespace maploop::tools {

// Empty: as configured. Throws std::runtime_error where the mode asked for needs a map, and there
// is none.
void set_map(vehicle::MapParameters& map, const std::filesystem::path& file,
             std::optional<vehicle::MapMode> mode);

}  // namespace maploop::tools
