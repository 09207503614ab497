// Writes a whole file in one call.
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace maploop::simulate {

// Throws std::runtime_error naming the file and the reason, such as a full disk.
inline void write_file(const std::filesystem::path& file, std::string_view bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out)
    throw std::runtime_error("cannot write '" + file.string() + "': " + std::strerror(errno));
}

}  // namespace maploop::simulate
