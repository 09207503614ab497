// Text files, plain or compressed.
#pragma once

#include <filesystem>
#include <string>

namespace maploop::evaluation {

// The whole file; .gz and plain alike. Throws std::runtime_error naming it where it cannot be read
// or its compressed data are damaged.
std::string read_text(const std::filesystem::path& file);

// Compressed where the name ends in .gz. Throws std::runtime_error naming the file where it cannot
// be written.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace maploop::evaluation
