// Makes a line of a RINEX header.
#pragma once

#include <string>

namespace maploop::testing {

inline std::string header_record(std::string content, const char* label) {
  content.resize(60, ' ');
  return content + label + '\n';
}

}  // namespace maploop::testing
