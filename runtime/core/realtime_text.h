// This file reads the text files of /proc and /sys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::runtime {

// Returns the whole file without the newline at its end; nothing if it cannot be read.
std::optional<std::string> read_system_file(const std::filesystem::path& path);

// Returns the text after "key:" at the beginning of a line, without surrounding blanks; nothing if
// no line begins so.
std::optional<std::string_view> line_value(std::string_view text, std::string_view key);

// Returns the integer at the beginning of the text; nothing if there is none.
std::optional<std::int64_t> parse_integer(std::string_view text);

// Parses a list of CPUs as the kernel writes it: "0-2,5" is 0 1 2 5. Returns nothing if it is not
// one.
std::optional<std::vector<int>> parse_cpu_list(std::string_view text);

// Does the reverse.
std::string to_cpu_list(const std::vector<int>& ascending);

}  // namespace maploop::runtime
