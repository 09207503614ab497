// Several logs as one, by time.
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

// Always the earliest of the logs' next events; of equally early ones that of the log named first.
// So the order inside each log is kept, also where its own times go back. Throws std::runtime_error
// when a file cannot be read or written, std::invalid_argument when the output is one of the logs.
MergeResult merge(std::span<const std::filesystem::path> logs, const schema::Schema& schema,
                  const std::filesystem::path& output);

}  // namespace maploop::lcm_log
