// Loads the message types that the log tools know.
#pragma once

#include <filesystem>
#include <span>

#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

// Returns the project's own types and those of other .lcm files. Throws std::runtime_error naming
// the file (and line) that cannot be read.
schema::Schema load_types(std::span<const std::filesystem::path> files);

}  // namespace maploop::lcm_log
