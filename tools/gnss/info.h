// Describes the contents of a GNSS file as text.
#pragma once

#include <filesystem>
#include <string>

#include "ppp/gnss_files.h"

namespace maploop::gnss {

// Reads a file into `files`, which must be empty. Throws ppp::ReadError.
std::string info(const std::filesystem::path& path, ppp::GnssFiles& files);

}  // namespace maploop::gnss
