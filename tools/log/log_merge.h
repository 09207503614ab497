// Merges several logs into one, by time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct MergeResult {
  std::uint64_t events = 0;
  std::uint64_t damages = 0, damaged_bytes = 0;  // left out
};

// Writes always the earliest of the logs' next events; among equally early ones that of the log
// named first. The order inside each log is therefore kept, even if its own times go back. Throws
// std::runtime_error if a file cannot be read or written, std::invalid_argument if the output is
// one of the logs.
MergeResult merge(std::span<const std::filesystem::path> logs, const schema::Schema& schema,
                  const std::filesystem::path& output);

}  // namespace maploop::lcm_log
