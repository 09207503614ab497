// JSON that several subcommands write.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "msgs/diagnostics.h"

namespace maploop::tools {

nlohmann::json to_json(const std::vector<RealtimeSetting>& settings);
nlohmann::json to_json(const SensorClock& clock);

// Throws std::runtime_error naming the file when it cannot be written.
void write_json_file(const std::filesystem::path& file, const nlohmann::json& json);

}  // namespace maploop::tools
