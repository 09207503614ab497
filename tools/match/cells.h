// Splits a line of text into cells.
#pragma once

#include <string_view>
#include <vector>

#include "msgs/input_limits.h"

namespace maploop::match {

using Cells = std::vector<std::string_view>;

// If a line has more than input_limits::columns cells, one more than that is returned, and the
// caller must refuse the line.
inline Cells split(std::string_view line, char separator) {
  Cells cells;
  while (cells.size() <= input_limits::columns) {
    const auto end = line.find(separator);
    cells.push_back(line.substr(0, end));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  return cells;
}

}  // namespace maploop::match
