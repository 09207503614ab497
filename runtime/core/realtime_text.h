// Reading the text files of /proc and /sys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::runtime {

// The file whole, without the newline at its end; nothing where it cannot be read.
std::optional<std::string> read_system_file(const std::filesystem::path& path);

// What follows "key:" at the begin of a line, without the blanks around it; nothing where no line
// starts so.
std::optional<std::string_view> line_value(std::string_view text, std::string_view key);

// The integer that the text starts with; nothing where it starts with none.
std::optional<std::int64_t> parse_integer(std::string_view text);

// A list of CPUs as the kernel writes it: "0-2,5" is 0 1 2 5. Nothing where it is not such a list.
std::optional<std::vector<int>> parse_cpu_list(std::string_view text);

// The reverse.
std::string to_cpu_list(const std::vector<int>& ascending);

}  // namespace maploop::runtime
