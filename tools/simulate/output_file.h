// Writes a whole file in one call.
#pragma once

#include <filesystem>
#include <string_view>

namespace maploop::simulate {

// Throws std::runtime_error naming the file and the reason, such as a full disk.
void write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace maploop::simulate
