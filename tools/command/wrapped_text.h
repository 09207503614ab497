// Text that fits a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace maploop::tools {

// Breaks lines that are longer than `width` between words. What goes on stands below the last
// column of the line, or below its begin where the line is none of a table: columns are at least
// two blanks apart. A word that is too long stays whole.
std::string wrapped(std::string_view text, std::size_t width);

}  // namespace maploop::tools
