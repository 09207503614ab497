// This file reads the text files of a recording and the numbers in them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::sensors {

// Reads a plain or gzip-compressed file. Throws FileError.
inline std::string read_text(const std::filesystem::path& file) {
  return maploop::read_text(file, input_limits::table);
}

// Returns the lines of a text without their line ends (LF or CRLF) and surrounding blanks; blank
// lines at the end of the text are left out.
std::vector<std::string_view> split_lines(std::string_view text);

// Returns the numbers of a text, which are separated by blanks. Throws std::invalid_argument that
// names the first word that is not a finite number, and its column (from 1).
std::vector<double> parse_numbers(std::string_view text);

// Returns the text in quotes as it can be shown to a user: without control characters, and of
// limited length.
std::string quoted(std::string_view text);

// Returns a name such as "0000000042.png", as KITTI names the files of a frame.
std::string numbered_file(std::size_t index, std::string_view extension);

}  // namespace maploop::sensors
