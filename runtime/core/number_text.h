// A number as text that reads back as the same number.
#pragma once

#include <string>

namespace maploop::runtime {

// With as few digits as that takes.
std::string shortest_text(double value);

}  // namespace maploop::runtime
