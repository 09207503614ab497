// Reading whole files of a recording, and the numbers in their text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::sensors {

// The content of a regular file into `bytes`, whose capacity is reused. Throws std::runtime_error
// with the reason alone (the caller knows the name): missing, not a regular file, larger than
// `limit` bytes, or not readable to its end.
void read_file(const std::filesystem::path& file, std::size_t limit, std::vector<char>& bytes);

// The same for text, plain or gzip-compressed, of at most 64 MB.
std::string read_text(const std::filesystem::path& file);

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
