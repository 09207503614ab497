// Describes the contents of a GNSS file as text.
#pragma once

#include <filesystem>
#include <string>

namespace maploop::gnss {

// Throws ppp::ReadError.
std::string info(const std::filesystem::path& path);

}  // namespace maploop::gnss
