// This file writes a number as text that reads back as the same number.
#pragma once

#include <string>

namespace maploop::runtime {

// Uses as few digits as possible.
std::string shortest_text(double value);

}  // namespace maploop::runtime
