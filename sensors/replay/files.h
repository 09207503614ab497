// The texts of a recording, and the numbers in them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::sensors {

// Plain or gzip-compressed. Throws FileError.
inline std::string read_text(const std::filesystem::path& file) {
  return maploop::read_text(file, input_limits::table);
}

// The lines of a text without their ends (LF or CRLF) and without the blanks around them; blank
// lines at the end of the text are not lines.
std::vector<std::string_view> split_lines(std::string_view text);

// The numbers of a text, separated by blanks. Throws std::invalid_argument naming the first word
// that is not a finite number, and its column (from 1).
std::vector<double> parse_numbers(std::string_view text);

// The text in quotes as it can be shown to a user: no control characters, and not endless.
std::string quoted(std::string_view text);

// "0000000042.png", as KITTI names the files of a frame.
std::string numbered_file(std::size_t index, std::string_view extension);

}  // namespace maploop::sensors
