// Reads and writes text files, plain or compressed.
#pragma once

#include <filesystem>
#include <string>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::evaluation {

// Reads the whole file, .gz or plain. Throws FileError.
inline std::string read_text(const std::filesystem::path& file) {
  return maploop::read_text(file, input_limits::track);
}

// Writes a compressed file if the name ends in .gz. The file then contains all of `text`, or its
// former contents after an error (msgs/whole_file.h). Throws std::runtime_error naming the
// file if it cannot be written.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace maploop::evaluation
