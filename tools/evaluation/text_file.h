// Text files, plain or compressed.
#pragma once

#include <filesystem>
#include <string>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::evaluation {

// The whole file; .gz and plain alike. Throws FileError.
inline std::string read_text(const std::filesystem::path& file) {
  return maploop::read_text(file, input_limits::track);
}

// Compressed where the name ends in .gz. The whole file, or what was there before
// (runtime/core/whole_file.h). Throws std::runtime_error naming the file where it cannot be
// written.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace maploop::evaluation
