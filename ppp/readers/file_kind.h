// What a GNSS file is, told by its content.
#pragma once

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
  ubx,
  rtcm3,
  unknown
};

FileKind file_kind(std::string_view text);
const char* name(FileKind kind);

}  // namespace maploop::ppp
