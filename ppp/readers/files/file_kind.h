// Determines the kind of a GNSS file by its content.
#pragma once

#include <filesystem>
#include <string_view>

namespace maploop::ppp {

enum class FileKind {
  observation,
  navigation,
  orbit,
  clock,
  antenna,
  bias,
  dcb,
  earth_rotation,
  ocean_loading,
  ionosphere_maps,
  attitude,
  ubx,
  rtcm3,
  unknown
};

FileKind file_kind(std::string_view text);
// Determines the kind of a file, plain or .gz, from its first kilobytes. Throws ReadError if it
// cannot be read.
FileKind kind_of_file(const std::filesystem::path& path);
const char* name(FileKind kind);

}  // namespace maploop::ppp
